#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/pose.h"

namespace lumibox::geometry {

/// Several cameras and points that all of them see, related to the first camera. The unit of length
/// is the distance from the first camera to the farthest other.
struct MultiView {
  std::vector<Pose> view_from_first;  ///< of the views after the first
  /// Of each point, 1 / distance from the first camera along the bearing there. Negative where
  /// noise puts a point beyond infinity.
  std::vector<double> inverse_distance;
  double sigma_rad = 0.0;              ///< noise of one coordinate of a bearing, from the residuals
  std::vector<double> squared_errors;  ///< rad^2 of each point: mean over the views
  /// Standard deviation of each inverse distance, in inverse lengths, from the residuals' noise and
  /// the uncertainty of all cameras; that of the common scale, which nobody can know, left out.
  std::vector<double> inverse_distance_sigma;
};

enum class MotionFreedom {
  All,
  LastDirectionHeld,  ///< the direction from the first camera to the last stays
};

/// Adjusts cameras and points together from tracks: bearings[v][i] is the unit vector along which
/// view v saw point i. Those of view 0 are taken as exact: tracks are compared with the picture
/// there, so what they mean is defined there. Minimises Huber's function of the angular errors
/// (Levenberg-Marquardt; the points, one parameter each, are eliminated as in Triggs et al.,
/// "Bundle adjustment - a modern synthesis", 2000, section 6). Points in inverse distance (Civera,
/// Davison and Montiel, 2008) stay regular towards infinity. `start` gives the views after the
/// first; its inverse distances may be zero. At least two views and ten points.
MultiView adjust_multi_view(const std::vector<std::vector<Eigen::Vector3d>>& bearings,
                            const MultiView& start, int max_iterations,
                            MotionFreedom freedom = MotionFreedom::All);

/// Median over the points of sigma / |inverse distance|: the relative error of a typical depth.
/// About 1 or more where there is no parallax, however sure the cameras.
double relative_depth_sigma(const MultiView& views);

}  // namespace lumibox::geometry
