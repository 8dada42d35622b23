#include "geometry/plane.h"

#include <cmath>

namespace lumibox::geometry {

Plane transform(const Pose& target_from_source, const Plane& plane_in_source) {
  const Eigen::Vector3d normal = target_from_source.rotation * plane_in_source.normal;
  return {normal, plane_in_source.offset + normal.dot(target_from_source.translation)};
}

std::optional<Eigen::Vector3d> intersect(const Plane& plane, const Eigen::Vector3d& origin,
                                         const Eigen::Vector3d& direction) {
  const double towards = plane.normal.dot(direction);
  if (!(std::abs(towards) > 1e-12 * direction.norm())) return std::nullopt;
  const double t = -plane.signed_distance(origin) / towards;
  if (!(t > 0.0)) return std::nullopt;
  return origin + t * direction;
}

std::optional<Eigen::Matrix3d> plane_homography(const Pose& b_from_a, const Plane& plane_in_a) {
  if (!(std::abs(plane_in_a.offset) > 1e-12)) return std::nullopt;
  return b_from_a.matrix3() +
         b_from_a.translation * plane_in_a.normal.transpose() / plane_in_a.offset;
}

}  // namespace lumibox::geometry
