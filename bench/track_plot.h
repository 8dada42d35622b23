#pragma once

#include <string>
#include <vector>

#include "bench/svg.h"
#include "geometry/pose.h"
#include "hal/replay/sequence.h"
#include "tracking/tracked_frame.h"

namespace lumibox::bench {

/// One frame of a recording as the tracker saw it.
struct PlottedFrame {
  double timestamp_s = 0.0;
  tracking::TrackingState state = tracking::TrackingState::Initialising;
  tracking::TrackingReason reason = tracking::TrackingReason::None;
  int measurements = 0;  ///< map points found
  double ms = 0.0;       ///< spent in the tracker
};

/// What tracking a recording came to. Poses, points and places are in the map's world, but for
/// `truth`, which has a world of its own; both trajectories are by time.
struct TrackPlot {
  std::string title;
  std::vector<std::string> figures;  ///< lines of text under the title
  std::vector<PlottedFrame> frames;  ///< all, in order
  std::vector<hal::StampedPose> live;
  std::vector<hal::StampedPose> corrected;
  std::vector<hal::StampedPose> truth;  ///< may be empty
  std::vector<Eigen::Vector3d> points;
  std::vector<geometry::Pose> keyframes;
  std::vector<Eigen::Vector3d> perspectives;  ///< centres; empty if none were captured
};

/// A page for those who work on the tracker: the map from above and from the side, and what
/// happened over time. With a truth everything is shown in its world and units, aligned by the
/// final trajectory; the errors are each trajectory's own, as `track --json` has them.
Svg draw_track(const TrackPlot& plot);

}  // namespace lumibox::bench
