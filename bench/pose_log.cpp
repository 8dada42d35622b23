#include "bench/pose_log.h"

namespace lumibox::bench {

void PoseLog::add(const tracking::TrackedFrame& frame) {
  if (!frame.world_from_camera) {
    return;
  }
  entries_.push_back({{1e-9 * static_cast<double>(frame.timestamp_ns), *frame.world_from_camera},
                      frame.keyframe,
                      frame.keyframe_from_camera});
}

std::vector<hal::StampedPose> PoseLog::live() const {
  std::vector<hal::StampedPose> trajectory;
  for (const Entry& entry : entries_) {
    trajectory.push_back(entry.live);
  }
  return trajectory;
}

std::vector<hal::StampedPose> PoseLog::corrected(const tracking::Tracker& tracker) const {
  std::vector<hal::StampedPose> trajectory = live();
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (const auto keyframe = tracker.world_from_keyframe(entries_[i].keyframe)) {
      trajectory[i].world_from_camera = *keyframe * entries_[i].keyframe_from_camera;
    }
  }
  return trajectory;
}

}  // namespace lumibox::bench
