#include "geometry/rotation.h"

#include <cmath>

namespace lumibox::geometry {

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond exp_so3(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  const double half = 0.5 * angle;
  // sin(half)/angle; below 1e-4 the next term of the series is under 1e-17 of the first.
  const double sinc = angle < 1e-4 ? 0.5 - half * half / 12.0 : std::sin(half) / angle;
  const Eigen::Vector3d xyz = sinc * rotation_vector;
  return Eigen::Quaterniond(std::cos(half), xyz.x(), xyz.y(), xyz.z()).normalized();
}

Eigen::Vector3d log_so3(const Eigen::Quaterniond& q) {
  // atan2 keeps full accuracy at 0 and at pi; taking the sign of w makes q and -q the same.
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d xyz = sign * q.vec();
  const double w = sign * q.w();
  const double sin_half = xyz.norm();
  if (sin_half < 1e-8) return xyz * (2.0 / w);
  return xyz * (2.0 * std::atan2(sin_half, w) / sin_half);
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double length_a = a.norm();
  const double length_b = b.norm();
  if (length_a == 0.0 || length_b == 0.0) return 0.0;
  const Eigen::Vector3d u = a / length_a;
  const Eigen::Vector3d v = b / length_b;
  return 2.0 * std::atan2((u - v).norm(), (u + v).norm());
}

Eigen::Matrix<double, 3, 2> tangent_basis(const Eigen::Vector3d& unit) {
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = unit.unitOrthogonal();
  basis.col(1) = unit.cross(basis.col(0));
  return basis;
}

Eigen::Quaterniond canonical(const Eigen::Quaterniond& q) {
  return q.w() < 0.0 ? Eigen::Quaterniond(-q.w(), -q.x(), -q.y(), -q.z()) : q;
}

Eigen::Vector3d slerp(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double t) {
  const double angle = angle_between(from, to);
  Eigen::Vector3d side = to - from.dot(to) * from;  // the part of `to` perpendicular to `from`
  if (side.norm() < 4e-16) side = from.unitOrthogonal();  // rounding, no direction
  side.normalize();
  // Of a short difference the rounding was enlarged with it; what of it lies along `from` goes now.
  side = (side - from.dot(side) * from).normalized();
  return (std::cos(t * angle) * from + std::sin(t * angle) * side).normalized();
}

}  // namespace lumibox::geometry
