#include <array>
#include <optional>

#include "config/error.h"
#include "config/input_file.h"
#include "geometry/position.h"
#include "lightfield/colmap_parts.h"
#include "lightfield/text_numbers.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;

/// A text file line by line; comments are left out, empty lines are not.
class Lines {
 public:
  explicit Lines(const fs::path& file) : file_(file), text_(config::read_text(file)) {}

  /// Next line without its end, or none.
  std::optional<std::string_view> next() {
    while (begin_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', begin_), text_.size());
      const std::string_view line = std::string_view(text_).substr(begin_, end - begin_);
      begin_ = end + 1;
      ++number_;
      if (!line.starts_with('#')) return line;
    }
    return std::nullopt;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw config::InputError(file_, number_, message);
  }

  /// The word as a number, or fails.
  template <typename Number>
  Number number(std::string_view word) const {
    Number value{};
    if (!parse(word, &value)) fail("not a number: " + printable(word));
    return value;
  }

 private:
  fs::path file_;
  std::string text_;
  std::size_t begin_ = 0;
  int number_ = 0;
};

std::map<std::int64_t, config::CameraProfile> read_cameras(const fs::path& file) {
  std::map<std::int64_t, config::CameraProfile> cameras;
  Lines lines(file);
  while (const auto line = lines.next()) {
    const auto words = split_words(*line);
    if (words.empty()) continue;
    if (words.size() < 4) lines.fail("expected CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]");
    const ColmapLens* lens = find_lens(words[1]);
    if (!lens) lines.fail("camera model " + printable(words[1]) + ", " + kKnownLenses);
    if (words.size() != 4 + lens->parameters) {
      lines.fail(std::to_string(words.size() - 4) + " parameters, " + std::string(lens->name) +
                 " has " + std::to_string(lens->parameters));
    }
    std::vector<double> parameters;
    for (std::size_t i = 4; i < words.size(); ++i) {
      parameters.push_back(lines.number<double>(words[i]));
    }
    std::string flaw;
    const config::CameraProfile profile =
        to_profile(*lens, lines.number<long long>(words[2]), lines.number<long long>(words[3]),
                   parameters, &flaw);
    if (!flaw.empty()) lines.fail(flaw);
    if (!cameras.emplace(lines.number<long long>(words[0]), profile).second) {
      lines.fail("camera id " + printable(words[0]) + " twice");
    }
  }
  return cameras;
}

std::vector<ColmapImage> read_images(const fs::path& file) {
  std::vector<ColmapImage> images;
  Lines lines(file);
  while (const auto line = lines.next()) {
    const auto words = split_words(*line);
    if (words.empty()) continue;
    if (words.size() < 10) lines.fail("expected IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME");
    lines.number<long long>(words[0]);  // the id: nothing here refers to it
    std::array<double, 7> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      numbers[i] = lines.number<double>(words[i + 1]);
    }
    ColmapImage image;
    std::string flaw;
    image.camera_from_world = to_pose(numbers, &flaw);
    if (!flaw.empty()) lines.fail("the image has " + flaw);
    image.camera_id = lines.number<long long>(words[8]);
    // The name is the rest of the line: it may hold spaces.
    image.name = std::string(words[9].data(), words.back().data() + words.back().size());
    images.push_back(std::move(image));
    lines.next();  // its 2D points, possibly none
  }
  return images;
}

std::vector<Eigen::Vector3d> read_points(const fs::path& file) {
  std::vector<Eigen::Vector3d> points;
  Lines lines(file);
  while (const auto line = lines.next()) {
    const auto words = split_words(*line);
    if (words.empty()) continue;
    if (words.size() < 8) lines.fail("expected POINT3D_ID X Y Z R G B ERROR TRACK[]");
    points.emplace_back(lines.number<double>(words[1]), lines.number<double>(words[2]),
                        lines.number<double>(words[3]));
    if (const auto fault = geometry::fault_of_position(points.back())) lines.fail(*fault);
  }
  return points;
}

}  // namespace

ColmapParts read_colmap_text(const fs::path& folder) {
  ColmapParts parts{read_cameras(folder / "cameras.txt"), read_images(folder / "images.txt"), {}};
  std::error_code error;
  if (fs::exists(folder / "points3D.txt", error)) {
    parts.points = read_points(folder / "points3D.txt");
  }
  return parts;
}

}  // namespace lumibox::lightfield
