#include "app/trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lumibox::app {
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

}  // namespace

std::optional<TrajectoryError> compare_trajectories(const std::vector<hal::StampedPose>& estimate,
                                                    const std::vector<hal::StampedPose>& truth,
                                                    double tolerance_s) {
  Eigen::Matrix3Xd estimated(3, static_cast<Eigen::Index>(estimate.size()));
  Eigen::Matrix3Xd actual(3, estimated.cols());
  Eigen::Index pairs = 0;
  for (const hal::StampedPose& pose : estimate) {
    if (const auto* match = nearest_in_time(truth, pose.timestamp_s, tolerance_s)) {
      estimated.col(pairs) = pose.world_from_camera.translation;
      actual.col(pairs) = match->world_from_camera.translation;
      ++pairs;
    }
  }
  if (pairs < 3) {
    return std::nullopt;
  }
  estimated.conservativeResize(3, pairs);
  actual.conservativeResize(3, pairs);

  TrajectoryError error;
  error.poses = static_cast<int>(pairs);
  error.truth_from_estimate = geometry::align_umeyama(estimated, actual);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < pairs; ++i) {
    sum += (error.truth_from_estimate * estimated.col(i) - actual.col(i)).squaredNorm();
  }
  error.rmse = std::sqrt(sum / static_cast<double>(pairs));
  const double extent = (actual.rowwise().maxCoeff() - actual.rowwise().minCoeff()).norm();
  error.rmse_percent = extent > 0.0 ? 100.0 * error.rmse / extent : 0.0;
  return error;
}

}  // namespace lumibox::app
