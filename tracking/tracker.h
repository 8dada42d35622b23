#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "geometry/pose.h"
#include "hal/image.h"
#include "tracking/tracked_frame.h"

namespace lumibox::tracking {

struct FrameMeasurements;
struct MapView;

/// A point of the map as others see it.
struct MapPoint {
  Eigen::Vector3d position;  ///< in world
  int observations = 0;      ///< keyframes that see it
};

struct TrackerStatistics {
  int keyframes = 0;
  int points = 0;
  int relocalisations = 0;
  int loops_closed = 0;
};

/// Who runs the mapper.
enum class Mapping {
  Lockstep,  ///< track() does, in turn: two runs are identical to the bit
  Threaded,  ///< a thread of its own: mapping never delays a frame
};

/// Monocular visual odometry with a map: a grey frame in, a pose out (thesis 2.1; Klein and Murray,
/// "Parallel Tracking and Mapping for Small AR Workspaces", ISMAR 2007). Bad frames are a state
/// with a reason, never an exception.
class Tracker {
 public:
  /// With a `saved` map of the same camera it goes on in that: lost at first, until a known place
  /// shows; whatever the pictures show, no other map begins by itself. Keyframes keep their ids.
  Tracker(const geometry::Camera& camera, const config::Tracking& options, Mapping mapping,
          std::uint32_t seed, std::shared_ptr<const MapView> saved = nullptr);
  ~Tracker();
  Tracker(const Tracker&) = delete;
  Tracker& operator=(const Tracker&) = delete;

  /// Forgets the map, because the person asks for it: the next frames begin a new one, in a world
  /// of its own.
  void start_over();

  /// Tracks one frame of the camera's size. Frames come in order of time. `before_mapping` is
  /// called when the frame is tracked and the mapper, which in lockstep has its turn before this
  /// returns, has not begun: for those who measure what a frame costs on the box.
  TrackedFrame track(const hal::Image& gray, std::int64_t index, std::int64_t timestamp_ns,
                     const std::function<void()>& before_mapping = {});

  /// Current estimate of a keyframe's place; none if it never existed. Its scale is what closing
  /// loops has multiplied lengths around it by, 1 until then. A culled keyframe keeps answering
  /// through the keyframe it was tied to.
  std::optional<geometry::Similarity> world_from_keyframe(KeyframeId id) const;

  /// Counts map corrections: while it stays the same, no keyframe has moved.
  std::uint64_t map_revision() const;

  /// All of the map as it is now, to be kept; null before there is one.
  std::shared_ptr<const MapView> map() const;

  /// Copy of the map's reliable points.
  std::vector<MapPoint> points() const;

  /// Points that the last tracked frame measured, in world.
  std::vector<Eigen::Vector3d> visible_points() const;

  /// All that the pose of the last tracked frame was estimated from.
  const FrameMeasurements& measurements() const;

  TrackerStatistics statistics() const;

  /// True while the mapper has work; never in lockstep.
  bool mapping() const;

  /// Waits for the mapper and runs the final adjustment.
  void finish();

  /// What ended the mapping, an error of the program or of memory; none if all is well. Tracking
  /// goes on with the map as it was.
  std::optional<std::string> mapping_error() const;

 private:
  class Impl;
  std::function<std::unique_ptr<Impl>()> begin_;  ///< without a map
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::tracking
