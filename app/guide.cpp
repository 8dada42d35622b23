#include "app/guide.h"

#include "geometry/rotation.h"

namespace lumibox::app {
namespace {

/// Of a unit vector, seen from its tip: below, it does not point anywhere on the screen.
constexpr double kNoWay = 0.05;

}  // namespace

const lightfield::Holes& Guide::holes(const lightfield::LightField& light_field, double threshold) {
  std::vector<Eigen::Vector3d> directions;
  if (light_field.subject()) {
    for (const auto& perspective : light_field.perspectives()) {
      directions.push_back(perspective.center() - light_field.subject()->center);
    }
  }
  if (directions != directions_ || threshold != threshold_) {
    holes_ = finder_.find(directions, threshold, widest_gap_);
    directions_ = std::move(directions);
    threshold_ = threshold;
  }
  return holes_;
}

std::optional<Eigen::Vector2d> way_to(const Eigen::Vector3d& direction,
                                      const geometry::Pose& world_from_camera,
                                      const Eigen::Vector3d& subject, double tolerance) {
  const Eigen::Vector3d here = world_from_camera.translation - subject;
  if (!(here.norm() > 0.0) || geometry::angle_between(here, direction) <= tolerance) {
    return std::nullopt;
  }
  // The tangent of the great circle at the camera, on the screen; opposite S any way is as short.
  const Eigen::Vector3d across = here.cross(direction).normalized();
  const Eigen::Vector3d tangent = across.cross(here).normalized();
  const Eigen::Vector3d in_camera = world_from_camera.rotation.conjugate() * tangent;
  if (!(in_camera.head<2>().norm() > kNoWay)) {
    return std::nullopt;
  }
  return in_camera.head<2>().normalized();
}

}  // namespace lumibox::app
