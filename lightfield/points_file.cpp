#include "lightfield/points_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <string_view>

#include "config/input_file.h"
#include "geometry/position.h"
#include "lightfield/byte_reader.h"
#include "lightfield/text_numbers.h"

namespace lumibox::lightfield {
namespace {

/// One scalar property of a vertex.
struct Property {
  std::size_t bytes = 4;
  int axis = -1;  ///< 0 x, 1 y, 2 z, -1 anything else
};

struct Header {
  bool binary = false;
  std::uint64_t vertices = 0;
  std::vector<Property> properties;
};

Property parse_property(ByteReader& reader, std::string_view type, std::string_view name) {
  struct Type {
    std::string_view name;
    std::string_view alias;
    std::size_t bytes;
    bool floating;
  };
  static constexpr std::array<Type, 8> kTypes{{{"char", "int8", 1, false},
                                               {"uchar", "uint8", 1, false},
                                               {"short", "int16", 2, false},
                                               {"ushort", "uint16", 2, false},
                                               {"int", "int32", 4, false},
                                               {"uint", "uint32", 4, false},
                                               {"float", "float32", 4, true},
                                               {"double", "float64", 8, true}}};
  for (const Type& known : kTypes) {
    if (type != known.name && type != known.alias) continue;
    const int axis = name == "x" ? 0 : name == "y" ? 1 : name == "z" ? 2 : -1;
    if (axis >= 0 && !known.floating) reader.fail("x, y and z must be float or double");
    return {known.bytes, axis};
  }
  reader.fail("property of unknown type " + printable(type));
}

Header read_header(ByteReader& reader) {
  Header header;
  bool has_format = false;
  int elements = 0;
  const auto expect = [&reader](bool holds, const std::string& line) {
    if (!holds) reader.fail("not the header of a PLY file: \"" + printable(line) + "\"");
  };
  for (bool first = true;; first = false) {
    const std::string line = reader.read_until('\n');
    const auto words = split_words(line);
    if (first) {
      expect(words.size() == 1 && words[0] == "ply", line);
      continue;
    }
    expect(!words.empty(), line);
    if (words[0] == "end_header") break;
    if (words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format") {
      expect(words.size() == 3 && (words[1] == "ascii" || words[1] == "binary_little_endian"),
             line);
      header.binary = words[1] != "ascii";
      has_format = true;
    } else if (words[0] == "element") {
      long long count = 0;
      expect(words.size() == 3 && parse(words[2], &count) && count >= 0, line);
      expect(++elements > 1 || words[1] == "vertex", line);
      if (elements == 1) header.vertices = static_cast<std::uint64_t>(count);
    } else {
      expect(words[0] == "property" && elements > 0, line);
      if (elements > 1) continue;  // what follows the vertices is not read
      expect(words.size() == 3, line);
      header.properties.push_back(parse_property(reader, words[1], words[2]));
    }
  }
  std::array<int, 3> seen{};
  for (const Property& property : header.properties) {
    if (property.axis >= 0) ++seen[static_cast<std::size_t>(property.axis)];
  }
  if (!has_format || seen != std::array{1, 1, 1}) {
    reader.fail("expected a PLY file with a format and one vertex property each of x, y and z");
  }
  return header;
}

Eigen::Vector3d read_binary_vertex(ByteReader& reader, const Header& header) {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (const Property& property : header.properties) {
    if (property.axis < 0) {
      reader.skip(1, property.bytes);
    } else {
      point[property.axis] = property.bytes == 8 ? reader.read<double>() : reader.read<float>();
    }
  }
  return point;
}

Eigen::Vector3d read_ascii_vertex(ByteReader& reader, const Header& header) {
  const std::string line = reader.read_until('\n');
  const auto words = split_words(line);
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  bool good = words.size() == header.properties.size();
  for (std::size_t i = 0; good && i < words.size(); ++i) {
    const int axis = header.properties[i].axis;
    if (axis >= 0) good = parse(words[i], &point[axis]);
  }
  if (!good) reader.fail("not a vertex: \"" + printable(line) + "\"");
  return point;
}

}  // namespace

std::vector<std::uint8_t> encode_ply(const std::vector<Eigen::Vector3d>& points) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points.size()) +
      "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  const std::size_t body = points.size() * sizeof(Eigen::Vector3d);
  std::vector<std::uint8_t> bytes(header.size() + body);
  std::memcpy(bytes.data(), header.data(), header.size());
  if (body > 0) std::memcpy(bytes.data() + header.size(), points.data(), body);
  return bytes;
}

std::vector<Eigen::Vector3d> read_ply(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = config::read_bytes(path);
  ByteReader reader(bytes, path);
  constexpr std::string_view kMagic = "ply";
  if (bytes.size() < kMagic.size() || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin())) {
    reader.fail("is no PLY file; expected one, which begins with the letters ply");
  }
  const Header header = read_header(reader);
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; i < header.vertices; ++i) {
    points.push_back(header.binary ? read_binary_vertex(reader, header)
                                   : read_ascii_vertex(reader, header));
    if (const auto fault = geometry::fault_of_position(points.back())) {
      reader.fail("vertex " + std::to_string(i) + " has " + *fault);
    }
  }
  return points;
}

}  // namespace lumibox::lightfield
