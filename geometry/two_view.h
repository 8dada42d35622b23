#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/bearing_pair.h"
#include "geometry/pose.h"

namespace lumibox::geometry {

enum class TwoViewOutcome {
  Ok,
  TooFewPoints,      ///< fewer pairs than min_inliers (or than the five that any model needs)
  NotEnoughInliers,  ///< no model explains min_inliers pairs that are not all on one line
  NoMotion,          ///< the pairs are equal to within noise: nothing moved
  RotationOnly,      ///< a pure rotation explains the pairs as well as any motion does
  LowParallax,       ///< there is a translation, but the points lie too far away to measure it
  PlaneAmbiguous,    ///< the points lie on a plane and fit two motions alike: see candidates
};

struct TwoViewOptions {
  double sigma_rad = 1e-3;  ///< noise of one coordinate of a bearing, about 0.5 px / focal length
  int min_inliers = 20;     ///< pairs that the motion must explain
  double min_parallax_rad = 0.0175;  ///< median angle between the rays at the points; 1 degree
  int max_iterations = 300;          ///< samples drawn at most, per model
  std::uint32_t seed = 1;            ///< same input and seed: same result, on any platform
};

struct TwoViewResult {
  TwoViewOutcome outcome = TwoViewOutcome::TooFewPoints;
  /// The best motion, translation of unit length. Also set, as far as known, when the outcome is
  /// LowParallax or PlaneAmbiguous; for RotationOnly and NoMotion the translation is zero.
  Pose second_from_first;
  /// All motions that remain possible, best first: two when the outcome is PlaneAmbiguous. A third
  /// view decides between them.
  std::vector<Pose> candidates;
  bool planar = false;        ///< a homography won the race
  std::vector<bool> inliers;  ///< for each pair, whether second_from_first explains it
  int inlier_count = 0;
  /// For each pair the point in the first camera's frame (baseline = 1); none for outliers and
  /// where the rays are parallel.
  std::vector<std::optional<Eigen::Vector3d>> points;
  double median_parallax_rad = 0.0;  ///< over the triangulated points
};

/// Relative motion of two calibrated views of a rigid scene, from point matches with outliers.
/// Essential matrix (five-point RANSAC), homography (four-point RANSAC) and pure rotation race;
/// the geometric robust information criterion decides (Torr, "An assessment of information criteria
/// for motion model selection", CVPR 1997). The winner is refined on the inliers' angular errors.
TwoViewResult solve_two_view(std::span<const BearingPair> pairs, const TwoViewOptions& options);

}  // namespace lumibox::geometry
