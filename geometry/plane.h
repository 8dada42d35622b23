#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/pose.h"

namespace lumibox::geometry {

/// The points x with normal . x = offset; the normal has unit length.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0.0;

  /// Plane through a point; `direction` need not have unit length but must not be zero.
  static Plane through(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) {
    const Eigen::Vector3d n = direction.normalized();
    return {n, n.dot(point)};
  }
  /// Distance of a point, positive on the side to which the normal points.
  double signed_distance(const Eigen::Vector3d& point) const { return normal.dot(point) - offset; }
};

/// The same plane in another frame.
Plane transform(const Pose& target_from_source, const Plane& plane_in_source);

/// Where the ray origin + t * direction, t > 0, meets the plane; none if it is parallel (to within
/// 1e-12 rad) or meets it behind the origin. The direction need not have unit length.
std::optional<Eigen::Vector3d> intersect(const Plane& plane, const Eigen::Vector3d& origin,
                                         const Eigen::Vector3d& direction);

/// Matrix H that maps homogeneous normalised coordinates (x/z, y/z, 1) of camera a to those of
/// camera b, up to scale, for points on the plane, given in camera a's frame (Hartley and
/// Zisserman, "Multiple View Geometry", 13.1): H = R + t n^T / d. None if the plane passes through
/// a's centre.
std::optional<Eigen::Matrix3d> plane_homography(const Pose& b_from_a, const Plane& plane_in_a);

}  // namespace lumibox::geometry
