#include "bench/trajectory.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace lumibox::bench {
namespace {

/// The true pose nearest in time; null if there is none within the tolerance.
const hal::StampedPose* nearest_in_time(const std::vector<hal::StampedPose>& truth, double time_s,
                                        double tolerance_s) {
  const auto after = std::ranges::lower_bound(truth, time_s, {}, &hal::StampedPose::timestamp_s);
  const hal::StampedPose* nearest = nullptr;
  double best_s = tolerance_s;
  for (auto it = after == truth.begin() ? after : after - 1; it != truth.end() && it <= after;
       ++it) {
    if (const double gap_s = std::abs(it->timestamp_s - time_s); gap_s < best_s) {
      best_s = gap_s;
      nearest = &*it;
    }
  }
  return nearest;
}

struct PosePair {
  double timestamp_s;
  geometry::Pose estimate;
  geometry::Pose truth;
};

std::vector<PosePair> pair_by_time(const std::vector<hal::StampedPose>& estimate,
                                   const std::vector<hal::StampedPose>& truth, double tolerance_s) {
  std::vector<PosePair> pairs;
  for (const hal::StampedPose& pose : estimate) {
    if (const auto* match = nearest_in_time(truth, pose.timestamp_s, tolerance_s)) {
      pairs.push_back({pose.timestamp_s, pose.world_from_camera, match->world_from_camera});
    }
  }
  return pairs;
}

double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

double rms(double sum_of_squares, std::size_t count) {
  return std::sqrt(sum_of_squares / static_cast<double>(count));
}

/// The turn of the world that minimises the sum of squared chords between the rotations (Markley et
/// al., "Averaging quaternions", 2007).
Eigen::Quaterniond best_turn(const std::vector<PosePair>& pairs) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (const PosePair& pair : pairs) {
    const Eigen::Quaterniond turn = pair.truth.rotation * pair.estimate.rotation.conjugate();
    sum += turn.coeffs() * turn.coeffs().transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(sum);
  return Eigen::Quaterniond(Eigen::Vector4d(eigen.eigenvectors().col(3)));
}

std::vector<PoseError> errors_by_pose(const std::vector<PosePair>& pairs,
                                      const geometry::Similarity& truth_from_estimate) {
  const Eigen::Quaterniond turn = best_turn(pairs);
  std::vector<PoseError> errors;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d place = truth_from_estimate * pair.estimate.translation;
    errors.push_back({pair.timestamp_s, (place - pair.truth.translation).norm(),
                      degrees(pair.truth.rotation.angularDistance(turn * pair.estimate.rotation))});
  }
  return errors;
}

double rms(const std::vector<PoseError>& errors, double PoseError::*part) {
  double squares = 0.0;
  for (const PoseError& error : errors) {
    squares += error.*part * error.*part;
  }
  return rms(squares, errors.size());
}

double subject_rmse_deg(const std::vector<PosePair>& pairs,
                        const geometry::Similarity& truth_from_estimate,
                        const Eigen::Vector3d& subject) {
  double squares = 0.0;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d a = pair.truth.translation - subject;
    const Eigen::Vector3d b = truth_from_estimate * pair.estimate.translation - subject;
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
    squares += angle * angle;
  }
  return degrees(rms(squares, pairs.size()));
}

}  // namespace

std::optional<TrajectoryError> compare_trajectories(const std::vector<hal::StampedPose>& estimate,
                                                    const std::vector<hal::StampedPose>& truth,
                                                    const std::optional<Eigen::Vector3d>& subject,
                                                    double tolerance_s) {
  const std::vector<PosePair> pairs = pair_by_time(estimate, truth, tolerance_s);
  if (pairs.size() < 3) {
    return std::nullopt;
  }
  Eigen::Matrix3Xd estimated(3, static_cast<Eigen::Index>(pairs.size()));
  Eigen::Matrix3Xd actual(3, estimated.cols());
  for (Eigen::Index i = 0; i < estimated.cols(); ++i) {
    estimated.col(i) = pairs[static_cast<std::size_t>(i)].estimate.translation;
    actual.col(i) = pairs[static_cast<std::size_t>(i)].truth.translation;
  }

  TrajectoryError error;
  error.poses = static_cast<int>(pairs.size());
  error.truth_from_estimate = geometry::align_umeyama(estimated, actual);
  error.by_pose = errors_by_pose(pairs, error.truth_from_estimate);
  error.rmse = rms(error.by_pose, &PoseError::distance);
  const double extent = (actual.rowwise().maxCoeff() - actual.rowwise().minCoeff()).norm();
  if (extent > 0.0) error.rmse_percent = 100.0 * error.rmse / extent;
  error.rotation_rmse_deg = rms(error.by_pose, &PoseError::rotation_deg);
  if (subject) {
    error.subject_rmse_deg = subject_rmse_deg(pairs, error.truth_from_estimate, *subject);
  }
  return error;
}

}  // namespace lumibox::bench
