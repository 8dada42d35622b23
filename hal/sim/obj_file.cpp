#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>

#include "config/error.h"
#include "config/input_file.h"
#include "hal/sim/mesh.h"

namespace lumibox::hal::sim {
namespace {

/// The file's lists, before corners that share position, texture and normal become one vertex.
class ObjReader {
 public:
  explicit ObjReader(const std::filesystem::path& file) : file_(file) {}

  Mesh read() {
    std::istringstream stream(config::read_text(file_));
    std::string text;
    while (std::getline(stream, text)) {
      ++line_;
      std::istringstream words(text);
      std::string keyword;
      words >> keyword;
      if (keyword == "v") positions_.push_back(numbers<3>(words));
      if (keyword == "vt") uv_.push_back(numbers<2>(words));
      if (keyword == "vn") normals_.push_back(numbers<3>(words));
      if (keyword == "f") add_face(words);
    }
    if (mesh_.triangles.empty()) throw config::InputError(file_, "has no faces");
    if (!all_have_normals_) smooth_normals(mesh_);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw config::InputError(file_, line_, message);
  }

  template <int N>
  Eigen::Vector<float, N> numbers(std::istringstream& words) const {
    Eigen::Vector<float, N> value;
    for (int i = 0; i < N; ++i) {
      if (!(words >> value[i]) || !std::isfinite(value[i])) {
        fail("expected " + std::to_string(N) + " numbers");
      }
    }
    return value;
  }

  /// Position in a list of an index that counts from 1, or from the end if negative; none if the
  /// corner does not give it.
  std::optional<std::size_t> index(const std::string& text, std::size_t size) const {
    if (text.empty()) return std::nullopt;
    std::istringstream stream(text);
    long value = 0;
    if (!(stream >> value) || !stream.eof()) fail("\"" + text + "\" is not an index");
    const long from_zero = value > 0 ? value - 1 : value + static_cast<long>(size);
    if (value == 0 || from_zero < 0 || from_zero >= static_cast<long>(size)) {
      fail("index " + text + " is outside the " + std::to_string(size) + " given so far");
    }
    return static_cast<std::size_t>(from_zero);
  }

  std::uint32_t corner(const std::string& word) {
    std::array<std::string, 3> parts;
    std::istringstream stream(word);
    for (std::string& part : parts) std::getline(stream, part, '/');
    const auto position = index(parts[0], positions_.size());
    const auto uv = index(parts[1], uv_.size());
    const auto normal = index(parts[2], normals_.size());
    if (!position) fail("\"" + word + "\" names no position");

    const auto [known, is_new] = corners_.try_emplace(
        {position, uv, normal}, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new) {
      const Eigen::Vector3f& p = positions_[*position];
      mesh_.positions.push_back(p);
      mesh_.uv.push_back(uv ? uv_[*uv] : Eigen::Vector2f(p.x(), p.y()));
      const bool usable = normal && normals_[*normal].norm() > 0.0f;
      mesh_.normals.push_back(usable ? normals_[*normal].normalized() : Eigen::Vector3f::UnitZ());
      all_have_normals_ = all_have_normals_ && usable;
    }
    return known->second;
  }

  /// A polygon becomes a fan of triangles.
  void add_face(std::istringstream& words) {
    std::vector<std::uint32_t> polygon;
    for (std::string word; words >> word;) polygon.push_back(corner(word));
    if (polygon.size() < 3) fail("expected a face of at least three corners");
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      mesh_.triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
    }
  }

  using Key = std::tuple<std::optional<std::size_t>, std::optional<std::size_t>,
                         std::optional<std::size_t>>;
  std::filesystem::path file_;
  int line_ = 0;
  std::vector<Eigen::Vector3f> positions_;
  std::vector<Eigen::Vector2f> uv_;
  std::vector<Eigen::Vector3f> normals_;
  std::map<Key, std::uint32_t> corners_;
  bool all_have_normals_ = true;
  Mesh mesh_;
};

}  // namespace

Mesh read_obj(const std::filesystem::path& file) {
  return ObjReader(file).read();
}

}  // namespace lumibox::hal::sim
