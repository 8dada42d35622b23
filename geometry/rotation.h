#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lumibox::geometry {

/// Matrix of the cross product: skew(a) * b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Unit quaternion of a rotation vector (axis times angle in radians, any size).
Eigen::Quaterniond exp_so3(const Eigen::Vector3d& rotation_vector);

/// Rotation vector of a unit quaternion, length in [0, pi]; q and -q give the same.
Eigen::Vector3d log_so3(const Eigen::Quaterniond& q);

/// Angle in [0, pi] between two vectors of any non-zero length, accurate at 0 and at pi, where acos
/// of the dot product is not. (Kahan, "How futile are mindless assessments of roundoff", 2006.)
/// 0 if either is zero.
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Two unit vectors that span the plane perpendicular to a unit vector, as columns.
Eigen::Matrix<double, 3, 2> tangent_basis(const Eigen::Vector3d& unit);

/// The same rotation with w >= 0, as written to files.
Eigen::Quaterniond canonical(const Eigen::Quaterniond& q);

/// Unit vector on the arc from unit vector `from` (t = 0) to unit vector `to` (t = 1). For
/// antiparallel vectors, where the arc is not unique, a fixed perpendicular is passed through.
Eigen::Vector3d slerp(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double t);

}  // namespace lumibox::geometry
