#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/bearing_pair.h"

namespace lumibox::geometry {

/// A model of how second bearings follow from first ones, with how well it does so.
struct ModelFit {
  Eigen::Matrix3d model = Eigen::Matrix3d::Identity();
  /// Geometric robust information criterion, less is better: each pair's squared error in units of
  /// its variance, plus ln 4 for each dimension of the point's own position that the model leaves
  /// free, clipped at kOutlierCost; plus ln(4 pairs) for each of the model's parameters (Torr, "An
  /// assessment of information criteria for motion model selection", CVPR 1997).
  double criterion = 0.0;
  std::vector<bool> inliers;  ///< pairs that cost less than kOutlierCost
  int inlier_count = 0;       ///< 0 if no sample gave a model
};

/// Torr clips each model's errors where that model's own noise ends, which rewards the model with
/// the most freedom for each outlier. A common bound makes outliers cost the same everywhere. With
/// 8, a pair is an inlier of an essential matrix up to 3.84 variances (95 % of 1 degree of freedom)
/// and of a homography up to 5.23 (93 % of 2).
inline constexpr double kOutlierCost = 8.0;

/// Squared error of an essential matrix, in variances, up to which a pair is an inlier.
double essential_bound();

struct RansacOptions {
  double sigma_rad = 1e-3;  ///< noise of one coordinate of a bearing
  int max_samples = 300;
  std::uint32_t seed = 1;
};

/// How well "nothing moved" does.
ModelFit assess_no_motion(std::span<const BearingPair> pairs, double sigma_rad);

// The best model of each kind by RANSAC, refined on its inliers. At least five pairs are needed.
ModelFit find_rotation(std::span<const BearingPair> pairs, const RansacOptions& options);
ModelFit find_homography(std::span<const BearingPair> pairs, const RansacOptions& options);
ModelFit find_essential(std::span<const BearingPair> pairs, const RansacOptions& options);

}  // namespace lumibox::geometry
