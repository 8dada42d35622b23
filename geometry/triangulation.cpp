#include "geometry/triangulation.h"

#include <cmath>
#include <cstddef>

#include "geometry/levenberg_marquardt.h"

namespace lumibox::geometry {
namespace {

// Eigen's allFinite subtracts infinities, which would trap where invalid operations are trapped.
bool is_finite(const Eigen::Vector3d& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

bool is_finite(const Pose& pose) {
  return std::isfinite(pose.rotation.w()) && is_finite(Eigen::Vector3d(pose.rotation.vec())) &&
         is_finite(pose.translation);
}

/// The same in the frame of camera b.
std::optional<Eigen::Vector3d> triangulate_in_b(const Pose& b_from_a,
                                                const Eigen::Vector3d& bearing_a,
                                                const Eigen::Vector3d& bearing_b) {
  const Eigen::Vector3d& t = b_from_a.translation;
  Eigen::Vector3d ray_a = b_from_a.rotation * bearing_a;
  Eigen::Vector3d ray_b = bearing_b;
  // Of the two rays, the one farther from the baseline spans the better epipolar plane; the other
  // is turned into that plane.
  const Eigen::Vector3d normal_a = ray_a.cross(t);
  const Eigen::Vector3d normal_b = ray_b.cross(t);
  const bool keep_a = normal_a.squaredNorm() > normal_b.squaredNorm();
  const Eigen::Vector3d& normal = keep_a ? normal_a : normal_b;
  const double normal_length2 = normal.squaredNorm();
  if (!(normal_length2 > 0.0)) return std::nullopt;
  Eigen::Vector3d& turned = keep_a ? ray_b : ray_a;
  turned -= normal * (turned.dot(normal) / normal_length2);

  const Eigen::Vector3d z = ray_b.cross(ray_a);
  const double z_length2 = z.squaredNorm();
  if (!(z_length2 > kMinTriangulationAngle * kMinTriangulationAngle)) return std::nullopt;
  const double along_a = z.dot(t.cross(ray_b)) / z_length2;
  const double along_b = z.dot(t.cross(ray_a)) / z_length2;
  if (!(along_a > 0.0 && along_b > 0.0)) return std::nullopt;
  return along_b * ray_b;
}

/// Index of the bearing whose direction in the world is farthest from that of bearing `from`.
std::size_t widest_partner(std::span<const Pose> cameras, std::span<const Eigen::Vector3d> bearings,
                           std::size_t from) {
  const auto direction = [&](std::size_t i) -> Eigen::Vector3d {
    return cameras[i].rotation.conjugate() * bearings[i];
  };
  const Eigen::Vector3d reference = direction(from);
  std::size_t widest = from;
  double largest = 0.0;
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    const double chord2 = (direction(i) - reference).squaredNorm();
    if (chord2 > largest) {
      largest = chord2;
      widest = i;
    }
  }
  return widest;
}

}  // namespace

std::optional<Eigen::Vector3d> triangulate(const Pose& a_from_world, const Pose& b_from_world,
                                           const Eigen::Vector3d& bearing_a,
                                           const Eigen::Vector3d& bearing_b) {
  if (!is_finite(a_from_world) || !is_finite(b_from_world) || !is_finite(bearing_a) ||
      !is_finite(bearing_b)) {
    return std::nullopt;
  }
  const Pose b_from_a = b_from_world * a_from_world.inverse();
  // A baseline below the rounding of the two translations that it is the difference of is zero.
  const double rounding =
      1e-14 * (a_from_world.translation.norm() + b_from_world.translation.norm());
  if (!(b_from_a.translation.norm() > rounding)) return std::nullopt;
  const auto in_b = triangulate_in_b(b_from_a, bearing_a, bearing_b);
  if (!in_b) return std::nullopt;
  return b_from_world.inverse() * *in_b;
}

std::optional<Eigen::Vector3d> triangulate(std::span<const Pose> cameras_from_world,
                                           std::span<const Eigen::Vector3d> bearings) {
  const std::size_t count = bearings.size();
  if (count < 2 || cameras_from_world.size() != count) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_finite(cameras_from_world[i]) || !is_finite(bearings[i])) return std::nullopt;
  }
  const std::size_t a = widest_partner(cameras_from_world, bearings, 0);
  const std::size_t b = widest_partner(cameras_from_world, bearings, a);
  const auto start =
      triangulate(cameras_from_world[a], cameras_from_world[b], bearings[a], bearings[b]);
  if (!start) return std::nullopt;

  const auto linearise = [&](const Eigen::Vector3d& point) {
    NormalEquations<3> sum;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d in_camera = cameras_from_world[i] * point;
      const double distance = in_camera.norm();
      if (!(distance > 0.0)) continue;
      const Eigen::Vector3d direction = in_camera / distance;
      const Eigen::Matrix<double, 2, 3> across = tangent_basis(bearings[i]).transpose();
      const Eigen::Matrix3d direction_by_point =
          (Eigen::Matrix3d::Identity() - direction * direction.transpose()) / distance *
          cameras_from_world[i].matrix3();
      sum.add<2>(across * direction, across * direction_by_point);
    }
    return sum;
  };
  const auto retract = [](const Eigen::Vector3d& point, const Eigen::Vector3d& step) {
    return Eigen::Vector3d(point + step);
  };
  const Eigen::Vector3d point = minimise<3>(*start, linearise, retract, 10);
  for (std::size_t i = 0; i < count; ++i) {
    if (!((cameras_from_world[i] * point).dot(bearings[i]) > 0.0)) return std::nullopt;
  }
  return point;
}

double parallax_angle(const Pose& a_from_world, const Pose& b_from_world,
                      const Eigen::Vector3d& point_in_world) {
  return angle_between(a_from_world.inverse().translation - point_in_world,
                       b_from_world.inverse().translation - point_in_world);
}

}  // namespace lumibox::geometry
