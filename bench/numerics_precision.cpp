// Would float do? The pose of a frame from its measurements, the one place of the tracker with many
// operations in double, written once for either.

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bench/numerics.h"
#include "geometry/pose.h"
#include "geometry/rotation.h"

namespace lumibox::geometry {
namespace {

constexpr double kFocal = 540.0;  // pixels
constexpr double kNoise = 0.5;    // pixels
constexpr double kTukey = 4.685 * kNoise;
constexpr int kSteps = 10;
constexpr std::size_t kPoints = 700;

template <typename Scalar>
struct Seen {
  Eigen::Matrix<Scalar, 3, 1> point;  // in world
  Eigen::Matrix<Scalar, 2, 1> pixel;  // from the principal point
};

template <typename Scalar>
struct RigidMotion {
  Eigen::Matrix<Scalar, 3, 3> rotation;
  Eigen::Matrix<Scalar, 3, 1> translation;
};

/// Iteratively reweighted least squares on SE(3) with Tukey's biweight at a known scale, as
/// tracking/pose_estimator.h does it.
template <typename Scalar>
RigidMotion<Scalar> find_pose(const std::vector<Seen<Scalar>>& seen, RigidMotion<Scalar> pose) {
  using Vector6 = Eigen::Matrix<Scalar, 6, 1>;
  const auto focal = static_cast<Scalar>(kFocal);
  const auto cutoff2 = static_cast<Scalar>(kTukey * kTukey);
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix<Scalar, 6, 6> hessian = Eigen::Matrix<Scalar, 6, 6>::Zero();
    Vector6 gradient = Vector6::Zero();
    for (const Seen<Scalar>& s : seen) {
      const Eigen::Matrix<Scalar, 3, 1> p = pose.rotation * s.point + pose.translation;
      const Scalar inverse = Scalar(1) / p.z();
      const Scalar x = p.x() * inverse;
      const Scalar y = p.y() * inverse;
      const Eigen::Matrix<Scalar, 2, 1> error = s.pixel - focal * Eigen::Matrix<Scalar, 2, 1>(x, y);
      const Scalar share = error.squaredNorm() / cutoff2;
      if (share >= Scalar(1)) continue;
      const Scalar weight = (Scalar(1) - share) * (Scalar(1) - share);
      Eigen::Matrix<Scalar, 2, 6> jacobian;
      jacobian << inverse, 0, -x * inverse, -x * y, 1 + x * x, -y,  //
          0, inverse, -y * inverse, -1 - y * y, x * y, x;
      jacobian *= focal;
      hessian.noalias() += weight * jacobian.transpose() * jacobian;
      gradient.noalias() += weight * jacobian.transpose() * error;
    }
    const Vector6 twist = hessian.ldlt().solve(gradient);
    // The group itself in double for either: once per step, it costs nothing.
    const Pose change = exp_se3(twist.template cast<double>());
    const Eigen::Matrix<Scalar, 3, 3> turn = change.matrix3().template cast<Scalar>();
    pose.rotation = turn * pose.rotation;
    pose.translation = turn * pose.translation + change.translation.template cast<Scalar>();
  }
  return pose;
}

std::vector<Seen<double>> make_measurements(const Pose& camera_from_world, double depth,
                                            Numbers* numbers) {
  std::vector<Seen<double>> seen(kPoints);
  for (Seen<double>& s : seen) {
    const double z = depth * (1.0 + 0.3 * numbers->next());
    const Eigen::Vector3d in_camera(0.55 * numbers->next() * z, 0.42 * numbers->next() * z, z);
    s.point = camera_from_world.inverse() * in_camera;
    // Uniform with the standard deviation wanted.
    const Eigen::Vector3d noise = std::sqrt(3.0) * kNoise * numbers->vector();
    s.pixel = kFocal * in_camera.head<2>() / in_camera.z() + noise.head<2>();
  }
  return seen;
}

template <typename To>
std::vector<Seen<To>> converted(const std::vector<Seen<double>>& seen) {
  std::vector<Seen<To>> result;
  for (const Seen<double>& s : seen) {
    result.push_back({s.point.template cast<To>(), s.pixel.template cast<To>()});
  }
  return result;
}

/// How far apart the poses show the points, at most, in pixels.
double apart_px(const std::vector<Seen<double>>& seen, const RigidMotion<double>& a,
                const RigidMotion<float>& b) {
  double most = 0.0;
  for (const Seen<double>& s : seen) {
    const Eigen::Vector3d in_a = a.rotation * s.point + a.translation;
    const Eigen::Vector3d in_b = b.rotation.cast<double>() * s.point + b.translation.cast<double>();
    most = std::max(most, kFocal * (in_a.head<2>() / in_a.z() - in_b.head<2>() / in_b.z()).norm());
  }
  return most;
}

}  // namespace

void compare_precision(Numbers* numbers) {
  // The camera near the world's origin, and a walk away from it.
  for (const double away : {1.0, 100.0}) {
    const Pose truth(exp_so3({0.2, -0.4, 0.1}), Eigen::Vector3d(0.3, away, -0.2));
    const auto seen = make_measurements(truth, 1.0, numbers);
    const auto seen_float = converted<float>(seen);
    Vector6d off;
    // A pixel or so: what the coarse pass leaves.
    off << 1e-3, -5e-4, 1e-3, 5e-4, 1e-3, -5e-4;
    const Pose start = exp_se3(off) * truth;
    const RigidMotion<double> from{start.matrix3(), start.translation};
    const RigidMotion<float> from_float{from.rotation.cast<float>(),
                                        from.translation.cast<float>()};
    const double px = apart_px(seen, find_pose(seen, from), find_pose(seen_float, from_float));
    compare(
        "pose in double, the camera " + std::to_string(static_cast<int>(away)) +
            " median depths from the origin",
        "float", 1, [&] { return find_pose(seen, from).translation.x(); },
        [&] { return static_cast<double>(find_pose(seen_float, from_float).translation.x()); },
        {{"apart_px", px}});
  }
}

}  // namespace lumibox::geometry
