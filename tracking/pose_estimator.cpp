#include "tracking/pose_estimator.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/robust.h"

namespace lumibox::tracking {
namespace {

constexpr double kTukey = 4.685;   // 95 % efficiency on Gaussian noise (Huber, 1981)
constexpr double kMinSigma = 0.3;  // pixels: alignment is not better than this, whatever MAD says
constexpr double kMaxInlierError = 3.0;  // pixels: a pose off by more explains nothing
constexpr double kMaxSigma = 4.0;        // pixels: more is no longer noise

using Jacobian = Eigen::Matrix<double, 2, 6>;

struct Residual {
  Eigen::Vector2d error = Eigen::Vector2d::Zero();  // pixels of the level
  Jacobian jacobian = Jacobian::Zero();             // by a twist from the left
  bool valid = false;
};

Residual residual_of(const geometry::Camera& camera, const Measurement& m,
                     const geometry::FramePose& pose) {
  Residual r;
  const Eigen::Vector3d p = geometry::row_from_frame(camera, pose.readout_twist, m.pixel.y()) *
                            (pose.camera_from_world * m.position);
  Eigen::Matrix<double, 2, 3> by_point;
  const auto pixel = camera.project(p, &by_point);
  if (!pixel) return r;
  const double inverse_scale = 1.0 / static_cast<double>(1 << m.level);
  r.error = (m.pixel - *pixel) * inverse_scale;
  // By a twist of the row's pose; that of the middle row differs in the second order only.
  r.jacobian.leftCols<3>() = by_point * inverse_scale;
  r.jacobian.rightCols<3>() = -by_point * inverse_scale * geometry::skew(p);
  r.valid = true;
  return r;
}

double robust_sigma(const std::vector<Residual>& residuals) {
  std::vector<double> lengths;
  lengths.reserve(residuals.size());
  for (const Residual& r : residuals) {
    if (r.valid) lengths.push_back(r.error.norm());
  }
  if (lengths.empty()) return kMaxSigma;
  // The median length of a 2D Gaussian is 1.1774 sigma.
  return std::clamp(geometry::median(std::move(lengths)) / 1.1774, kMinSigma, kMaxSigma);
}

/// One step of iteratively reweighted least squares; returns the squared length of the twist.
double improve(const std::vector<Residual>& residuals, Freedom freedom, PoseEstimate& estimate) {
  const double cutoff = kTukey * estimate.sigma_px;
  geometry::Matrix6d hessian = geometry::Matrix6d::Identity() * 1e-9;
  geometry::Vector6d gradient = geometry::Vector6d::Zero();
  for (const Residual& r : residuals) {
    if (!r.valid) continue;
    const double weight = geometry::tukey_weight(r.error.norm(), cutoff);
    if (weight == 0.0) continue;
    hessian.noalias() += weight * r.jacobian.transpose() * r.jacobian;
    gradient.noalias() += weight * r.jacobian.transpose() * r.error;
  }
  geometry::Vector6d step = geometry::Vector6d::Zero();
  if (freedom == Freedom::All) {
    step = hessian.ldlt().solve(gradient);
  } else {
    step.tail<3>() = hessian.bottomRightCorner<3, 3>().ldlt().solve(gradient.tail<3>());
  }
  if (!step.allFinite()) return 0.0;
  estimate.pose.camera_from_world = geometry::exp_se3(step) * estimate.pose.camera_from_world;
  return step.squaredNorm();
}

}  // namespace

PoseEstimate estimate_pose(const geometry::Camera& camera, std::span<Measurement> measurements,
                           const geometry::FramePose& start, int iterations, Freedom freedom) {
  PoseEstimate estimate{start, 0, kMaxSigma};
  std::vector<Residual> residuals(measurements.size());
  for (int iteration = 0; iteration < iterations; ++iteration) {
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      residuals[i] = residual_of(camera, measurements[i], estimate.pose);
    }
    estimate.sigma_px = robust_sigma(residuals);
    if (improve(residuals, freedom, estimate) < 1e-14) break;
  }
  const double bound = std::min(kTukey * estimate.sigma_px, kMaxInlierError);
  for (Measurement& m : measurements) {
    const Residual r = residual_of(camera, m, estimate.pose);
    m.inlier = r.valid && r.error.norm() < bound;
    estimate.inliers += m.inlier ? 1 : 0;
  }
  return estimate;
}

}  // namespace lumibox::tracking
