#include "app/orbit.h"

#include <cmath>
#include <vector>

namespace lumibox::app {
namespace {

/// Camera at `center` that looks at `target`; `up` need not be perpendicular.
geometry::Pose look_at(const Eigen::Vector3d& center, const Eigen::Vector3d& target,
                       const Eigen::Vector3d& up) {
  Eigen::Matrix3d world_from_camera;
  world_from_camera.col(2) = (target - center).normalized();
  world_from_camera.col(0) = world_from_camera.col(2).cross(up).normalized();
  world_from_camera.col(1) = world_from_camera.col(2).cross(world_from_camera.col(0));
  return {world_from_camera, center};
}

/// Where a camera stands as seen from S, in a frame whose pole is the cameras' mean up.
struct Direction {
  double azimuth = 0.0;
  double elevation = 0.0;
};

double root_mean_square(double sum_of_squares, std::size_t count) {
  return std::sqrt(sum_of_squares / static_cast<double>(count));
}

}  // namespace

std::optional<geometry::Pose> orbit_pose(const lightfield::LightField& light_field, double phase) {
  const auto& perspectives = light_field.perspectives();
  if (perspectives.empty() || !light_field.subject()) {
    return std::nullopt;
  }
  const Eigen::Vector3d subject = light_field.subject()->center;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double distance = 0.0;
  for (const auto& perspective : perspectives) {
    const Eigen::Vector3d from_subject = perspective.center() - subject;
    up -= perspective.world_from_camera.rotation * Eigen::Vector3d::UnitY();
    middle += from_subject.normalized();
    distance += from_subject.norm();
  }
  distance /= static_cast<double>(perspectives.size());
  up.normalize();

  // Axes of the horizontal plane; the first points to the middle of the perspectives.
  const Eigen::Vector3d ahead = (middle - middle.dot(up) * up).normalized();
  const Eigen::Vector3d aside = up.cross(ahead);
  std::vector<Direction> directions;
  Direction mean;
  for (const auto& perspective : perspectives) {
    const Eigen::Vector3d d = (perspective.center() - subject).normalized();
    directions.push_back({std::atan2(d.dot(aside), d.dot(ahead)), std::asin(d.dot(up))});
    mean.elevation += directions.back().elevation / static_cast<double>(perspectives.size());
  }
  Direction spread;
  for (const Direction& direction : directions) {
    spread.azimuth += direction.azimuth * direction.azimuth;
    spread.elevation +=
        (direction.elevation - mean.elevation) * (direction.elevation - mean.elevation);
  }
  const double azimuth = root_mean_square(spread.azimuth, directions.size()) * std::sin(phase);
  const double elevation =
      mean.elevation + root_mean_square(spread.elevation, directions.size()) * std::cos(phase);
  const Eigen::Vector3d direction =
      std::cos(elevation) * (std::cos(azimuth) * ahead + std::sin(azimuth) * aside) +
      std::sin(elevation) * up;
  return look_at(subject + distance * direction, subject, up);
}

}  // namespace lumibox::app
