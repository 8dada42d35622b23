#pragma once

#include <vector>

#include "geometry/pose.h"
#include "hal/replay/sequence.h"
#include "tracking/tracker.h"

namespace lumibox::bench {

/// The frames with a pose, in order: the poses as they were known then, and as they can be
/// corrected later.
class PoseLog {
 public:
  void add(const tracking::TrackedFrame& frame);

  bool empty() const { return entries_.empty(); }

  std::vector<hal::StampedPose> live() const;

  /// With all corrections of the map until now.
  std::vector<hal::StampedPose> corrected(const tracking::Tracker& tracker) const;

 private:
  struct Entry {
    hal::StampedPose live;
    tracking::KeyframeId keyframe = -1;
    geometry::Pose keyframe_from_camera;
  };
  std::vector<Entry> entries_;
};

}  // namespace lumibox::bench
