#include <array>

#include "config/input_file.h"
#include "geometry/position.h"
#include "lightfield/byte_reader.h"
#include "lightfield/colmap_parts.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;

std::map<std::int64_t, config::CameraProfile> read_cameras(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = config::read_bytes(file);
  ByteReader reader(bytes, file);
  std::map<std::int64_t, config::CameraProfile> cameras;
  const auto count = reader.read<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto id = reader.read<std::int32_t>();
    const auto model = reader.read<std::int32_t>();
    const ColmapLens* lens = find_lens(model);
    if (!lens) reader.fail("camera model " + foreign_lens_name(model) + ", " + kKnownLenses);
    const auto width = static_cast<std::int64_t>(reader.read<std::uint64_t>());
    const auto height = static_cast<std::int64_t>(reader.read<std::uint64_t>());
    std::vector<double> parameters(lens->parameters);
    for (double& parameter : parameters) parameter = reader.read<double>();
    std::string flaw;
    const config::CameraProfile profile = to_profile(*lens, width, height, parameters, &flaw);
    const std::string name = "camera " + std::to_string(id);
    if (!flaw.empty()) reader.fail(name + ": " + flaw);
    if (!cameras.emplace(id, profile).second) reader.fail(name + " is there twice");
  }
  return cameras;
}

std::vector<ColmapImage> read_images(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = config::read_bytes(file);
  ByteReader reader(bytes, file);
  std::vector<ColmapImage> images;
  const auto count = reader.read<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto id = reader.read<std::uint32_t>();
    std::array<double, 7> numbers{};
    for (double& number : numbers) number = reader.read<double>();
    ColmapImage image;
    std::string flaw;
    image.camera_from_world = to_pose(numbers, &flaw);
    if (!flaw.empty()) reader.fail("image " + std::to_string(id) + " has " + flaw);
    image.camera_id = reader.read<std::int32_t>();
    image.name = reader.read_until('\0');
    images.push_back(std::move(image));
    constexpr std::size_t kPointBytes = 2 * sizeof(double) + sizeof(std::int64_t);
    reader.skip(reader.read<std::uint64_t>(), kPointBytes);
  }
  return images;
}

std::vector<Eigen::Vector3d> read_points(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = config::read_bytes(file);
  ByteReader reader(bytes, file);
  std::vector<Eigen::Vector3d> points;
  const auto count = reader.read<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    reader.skip(1, sizeof(std::uint64_t));  // id
    const double x = reader.read<double>();
    const double y = reader.read<double>();
    const double z = reader.read<double>();
    points.emplace_back(x, y, z);
    if (const auto fault = geometry::fault_of_position(points.back())) {
      reader.fail("point " + std::to_string(i) + " has " + *fault);
    }
    reader.skip(1, 3 + sizeof(double));  // colour, error
    constexpr std::size_t kTrackBytes = 2 * sizeof(std::int32_t);
    reader.skip(reader.read<std::uint64_t>(), kTrackBytes);
  }
  return points;
}

}  // namespace

ColmapParts read_colmap_binary(const fs::path& folder) {
  ColmapParts parts{read_cameras(folder / "cameras.bin"), read_images(folder / "images.bin"), {}};
  std::error_code error;
  if (fs::exists(folder / "points3D.bin", error)) {
    parts.points = read_points(folder / "points3D.bin");
  }
  return parts;
}

}  // namespace lumibox::lightfield
