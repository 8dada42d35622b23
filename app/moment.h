#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/pose.h"
#include "hal/camera.h"
#include "hal/frame.h"
#include "lightfield/perspective.h"
#include "tracking/map_view.h"
#include "tracking/pose_refinement.h"
#include "tracking/tracked_frame.h"

namespace lumibox::app {

/// The tracker's map as it is now. While `revision` stays the same, nothing in it has moved.
struct MapNow {
  std::uint64_t revision = 0;
  std::function<std::optional<geometry::Similarity>(tracking::KeyframeId)> world_from_keyframe;
  std::function<std::vector<Eigen::Vector3d>()> points;  ///< the reliable ones, in world
  /// All of it, to be kept; null before there is a map.
  std::function<std::shared_ptr<const tracking::MapView>()> copy;
};

/// All that the modes see of the world in one tick.
struct Moment {
  std::int64_t now_ns = 0;         ///< Clock time of the tick
  hal::Frame frame;                ///< newest picture; color is null before the first one
  bool fresh = false;              ///< the picture came in this tick
  double tracking_ms = 0.0;        ///< spent tracking it, without the mapper; 0 on a virtual clock
  tracking::TrackedFrame tracked;  ///< of `frame`
  std::vector<Eigen::Vector3d> map_points;  ///< in world, those seen in `frame`
  /// What the pose of `frame` was estimated from; valid until the next one is tracked.
  const tracking::FrameMeasurements* measurements = nullptr;
  MapNow map;

  bool tracking_is_good() const {
    return fresh && tracked.state == tracking::TrackingState::Good && tracked.world_from_camera;
  }
};

/// The moment's picture as a perspective, without an id. Precondition: the moment has a pose;
/// `camera` is the one that took the picture.
lightfield::Perspective perspective_of(const Moment& moment,
                                       std::shared_ptr<const geometry::Camera> camera);

}  // namespace lumibox::app
