#include "lightfield/coverage.h"

namespace lumibox::lightfield {

std::optional<Eigen::Vector3d> dot_on_sphere(const Sphere& sphere, const Eigen::Vector3d& center) {
  const Eigen::Vector3d outward = center - sphere.center;
  const double distance = outward.norm();
  if (!(distance > 0.0)) return std::nullopt;
  return sphere.center + (sphere.radius / distance) * outward;
}

}  // namespace lumibox::lightfield
