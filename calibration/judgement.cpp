#include "calibration/judgement.h"

#include <algorithm>
#include <cstddef>

#include "geometry/rotation.h"

namespace lumibox::calibration {
namespace {

/// Which third of a side of `size` pixels.
std::size_t third(double pixel, int size) {
  return static_cast<std::size_t>(std::clamp(static_cast<int>(3.0 * (pixel + 0.5) / size), 0, 2));
}

/// The board's normal, on the side that is away from the camera.
Eigen::Vector3d normal_of(const geometry::Pose& camera_from_board) {
  const Eigen::Vector3d normal = camera_from_board.rotation * Eigen::Vector3d::UnitZ();
  return normal.dot(camera_from_board.translation) < 0.0 ? Eigen::Vector3d(-normal) : normal;
}

}  // namespace

Coverage coverage_of(std::span<const Sighting> sightings, int width, int height) {
  Coverage coverage{};
  for (const Sighting& sighting : sightings) {
    for (const Corner& corner : sighting) {
      ++coverage[third(corner.pixel.y(), height)][third(corner.pixel.x(), width)];
    }
  }
  return coverage;
}

std::string uncovered_parts(const Coverage& coverage) {
  constexpr const char* kNames[3][3] = {{"upper left", "upper middle", "upper right"},
                                        {"middle left", "middle", "middle right"},
                                        {"lower left", "lower middle", "lower right"}};
  std::string names;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      if (coverage[row][column] >= kFewestCornersInANinth) continue;
      names += (names.empty() ? "" : ", ") + std::string(kNames[row][column]);
    }
  }
  return names;
}

double tilt_of(const geometry::Pose& camera_from_board) {
  return geometry::angle_between(normal_of(camera_from_board), Eigen::Vector3d::UnitZ());
}

double largest_tilt(std::span<const geometry::Pose> camera_from_board) {
  double largest = 0.0;
  for (const geometry::Pose& pose : camera_from_board) largest = std::max(largest, tilt_of(pose));
  return largest;
}

double tilt_spread(std::span<const geometry::Pose> camera_from_board) {
  double largest = 0.0;
  for (const geometry::Pose& a : camera_from_board) {
    for (const geometry::Pose& b : camera_from_board) {
      largest = std::max(largest, geometry::angle_between(normal_of(a), normal_of(b)));
    }
  }
  return largest;
}

}  // namespace lumibox::calibration
