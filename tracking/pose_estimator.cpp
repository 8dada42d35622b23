#include "tracking/pose_estimator.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/robust.h"

namespace lumibox::tracking {
namespace {

constexpr double kTukey = 4.685;   // 95 % efficiency on Gaussian noise (Huber, 1981)
constexpr double kMinSigma = 0.3;  // pixels: alignment is not better than this, whatever MAD says
constexpr double kMaxInlierError = 3.0;  // pixels: a pose off by more explains nothing
constexpr double kMaxSigma = 4.0;        // pixels: more is no longer noise
// Squared length of a twist that changes nothing: a five-hundredth of a pixel where a pixel is a
// five-hundredth of the depth.
constexpr double kSettled = 1e-11;

using geometry::Matrix6d;
using geometry::Vector6d;

/// Twist that the weighted normal equations ask for; zero if they have no answer.
Vector6d solve(const Matrix6d& hessian, const Vector6d& gradient, Freedom freedom) {
  Vector6d step = Vector6d::Zero();
  if (freedom == Freedom::All) {
    step = hessian.ldlt().solve(gradient);
  } else {
    step.tail<3>() = hessian.bottomRightCorner<3, 3>().ldlt().solve(gradient.tail<3>());
  }
  return step.allFinite() ? step : Vector6d::Zero();
}

}  // namespace

double PoseEstimate::position_sigma() const {
  // The centre is -R't: a twist moves it by -R' times the twist's translation, to the first order.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance.topLeftCorner<3, 3>(),
                                                             Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(eigen.eigenvalues().maxCoeff(), 0.0));
}

void PoseEstimator::prepare(std::span<const Measurement> measurements,
                            const geometry::FramePose& pose) {
  const std::size_t count = measurements.size();
  residuals_.x.resize(count);
  residuals_.y.resize(count);
  residuals_.length.resize(count);
  residuals_.jacobian.resize(count);
  residuals_.row_from_frame.clear();
  if (camera_.profile().readout_s == 0.0) return;
  for (const Measurement& m : measurements) {
    residuals_.row_from_frame.push_back(
        geometry::row_from_frame(camera_, pose.readout_twist, m.pixel.y()));
  }
}

void PoseEstimator::evaluate(std::span<const Measurement> measurements,
                             const geometry::FramePose& pose) {
  const Eigen::Matrix3d rotation = pose.camera_from_world.matrix3();
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const Measurement& m = measurements[i];
    Eigen::Vector3d p = rotation * m.position + pose.camera_from_world.translation;
    if (!residuals_.row_from_frame.empty()) p = residuals_.row_from_frame[i] * p;
    Eigen::Matrix<double, 2, 3> by_point;
    const auto pixel = camera_.project(p, &by_point);
    if (!pixel) {
      residuals_.length[i] = std::numeric_limits<double>::infinity();
      continue;
    }
    const double inverse_scale = 1.0 / static_cast<double>(1 << m.level);
    const Eigen::Vector2d error = (m.pixel - *pixel) * inverse_scale;
    residuals_.x[i] = error.x();
    residuals_.y[i] = error.y();
    residuals_.length[i] = error.norm();
    // By a twist of the row's pose; that of the middle row differs in the second order only.
    residuals_.jacobian[i].leftCols<3>() = by_point * inverse_scale;
    residuals_.jacobian[i].rightCols<3>() = -by_point * inverse_scale * geometry::skew(p);
  }
}

double PoseEstimator::robust_sigma() {
  std::vector<double>& sorted = residuals_.sorted;
  sorted.clear();
  for (const double length : residuals_.length) {
    if (std::isfinite(length)) sorted.push_back(length);
  }
  if (sorted.empty()) return kMaxSigma;
  return std::clamp(geometry::upper_median(sorted) / geometry::kMedianLength, kMinSigma, kMaxSigma);
}

PoseEstimate PoseEstimator::estimate(std::span<Measurement> measurements,
                                     const geometry::FramePose& start, int iterations,
                                     Freedom freedom) {
  PoseEstimate estimate;
  estimate.pose = start;
  prepare(measurements, start);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    evaluate(measurements, estimate.pose);
    const double cutoff = kTukey * robust_sigma();
    Matrix6d hessian = Matrix6d::Identity() * 1e-9;
    Vector6d gradient = Vector6d::Zero();
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      const double weight = geometry::tukey_weight(residuals_.length[i], cutoff);
      if (weight == 0.0) continue;
      const auto& jacobian = residuals_.jacobian[i];
      hessian.noalias() += weight * jacobian.transpose() * jacobian;
      gradient.noalias() += weight * (residuals_.x[i] * jacobian.row(0).transpose() +
                                      residuals_.y[i] * jacobian.row(1).transpose());
    }
    const Vector6d step = solve(hessian, gradient, freedom);
    estimate.pose.camera_from_world = geometry::exp_se3(step) * estimate.pose.camera_from_world;
    if (step.squaredNorm() < kSettled) break;
  }
  evaluate(measurements, estimate.pose);
  estimate.sigma_px = robust_sigma();
  const double bound = std::min(kTukey * estimate.sigma_px, kMaxInlierError);
  Matrix6d information = Matrix6d::Identity() * 1e-9;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    Measurement& m = measurements[i];
    m.inlier = residuals_.length[i] < bound;
    if (!m.inlier) continue;
    ++estimate.inliers;
    information.noalias() += residuals_.jacobian[i].transpose() * residuals_.jacobian[i];
  }
  estimate.covariance = estimate.sigma_px * estimate.sigma_px * information.inverse();
  return estimate;
}

}  // namespace lumibox::tracking
