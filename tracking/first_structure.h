#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/pose.h"
#include "tracking/tracked_frame.h"

namespace lumibox::tracking {

/// bearings[v][i]: unit vector along which view v saw point i, in that camera's frame.
using Bearings = std::vector<std::vector<Eigen::Vector3d>>;

struct FirstStructureOptions {
  double noise_rad = 1e-3;        ///< of a followed corner, generous: decides what an outlier is
  int min_points = 80;            ///< that the motion must explain
  double max_depth_sigma = 0.03;  ///< relative, of a typical point; above, more parallax is needed
  std::uint32_t seed = 1;
};

struct FirstStructure {
  /// None if the structure is certain; otherwise what the person should do about it. All below is
  /// set only if there is a structure, certain or not.
  TrackingReason reason = TrackingReason::MoveSideways;
  std::vector<geometry::Pose> view_from_first;  ///< the farthest is one unit away from the first
  /// Of each point, in the first camera's frame; none for outliers and points of no certain depth.
  std::vector<std::optional<Eigen::Vector3d>> points;
};

/// Shape and motion from points followed through several views, or the reason why they do not tell.
///
/// Two-view models race on the first and the last view (geometry/two_view.h). What they propose is
/// adjusted over all views together, as is the dual of each: the other motion that moves the
/// picture alike, which a scene near a plane always has (Longuet-Higgins, "The reconstruction of a
/// plane surface from two perspective projections", 1986). All views decide between those. The
/// structure is certain when its depths are: parallax alone says nothing without the noise.
FirstStructure find_first_structure(const Bearings& bearings, const FirstStructureOptions& options);

/// Whether two structures of the same first view agree: `earlier` ended at view `view` of `later`.
/// The direction of the motion is what a wrong structure gets wrong.
bool agrees(const geometry::Pose& earlier, const geometry::Pose& later);

}  // namespace lumibox::tracking
