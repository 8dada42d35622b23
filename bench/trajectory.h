#pragma once

#include <optional>
#include <vector>

#include "geometry/pose.h"
#include "hal/replay/sequence.h"

namespace lumibox::bench {

/// How far one pose is from the true one after the alignment of its trajectory.
struct PoseError {
  double timestamp_s = 0.0;
  double distance = 0.0;      ///< between the positions, in the truth's units
  double rotation_deg = 0.0;  ///< between the orientations
};

/// How far a trajectory is from the truth.
struct TrajectoryError {
  int poses = 0;      ///< that have a true pose of the same time
  double rmse = 0.0;  ///< of the positions, in the truth's units
  /// Of the diagonal of the true positions' bounding box; none if that is zero.
  std::optional<double> rmse_percent;
  /// RMSE of the orientations after the one turn of the world that fits them best: positions do
  /// not matter, so it judges a camera that only turns.
  double rotation_rmse_deg = 0.0;
  /// RMSE of the angle true camera - subject - estimated camera; none without a subject.
  std::optional<double> subject_rmse_deg;
  geometry::Similarity truth_from_estimate;  ///< least squares over the positions
  std::vector<PoseError> by_pose;            ///< of the poses counted, by time
};

/// Compares positions after the best similarity (a monocular map has no scale of its own). Poses
/// and truth, both by time, belong together when their times differ by less than `tolerance_s`.
/// None with fewer than three pairs. `subject` is a place in the truth's world.
std::optional<TrajectoryError> compare_trajectories(
    const std::vector<hal::StampedPose>& estimate, const std::vector<hal::StampedPose>& truth,
    const std::optional<Eigen::Vector3d>& subject = std::nullopt, double tolerance_s = 0.02);

}  // namespace lumibox::bench
