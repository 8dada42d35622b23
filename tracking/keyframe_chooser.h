#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "tracking/map_tracking.h"
#include "tracking/map_view.h"
#include "tracking/mapper.h"
#include "tracking/motion_model.h"

namespace lumibox::tracking {

/// Distance from the nearest keyframe at which a new one is wanted, as a share of the depth.
double wanted_baseline(const config::Tracking& options);

/// A frame's place in the map: a keyframe and the pose relative to it.
struct Anchor {
  KeyframeId keyframe = -1;
  geometry::Pose keyframe_from_camera;
};

/// Decides which frames become keyframes: those that see the map from a new place, or that see too
/// little of it. Collects on the way what the frames between tell about the map's points.
class KeyframeChooser {
 public:
  KeyframeChooser(const geometry::Camera& camera, const config::Tracking& options);

  /// Notes which of the points expected in a frame were found.
  void note(const MapView& map, const Localisation& found);

  /// The camera was lost and found: the next good frame is to become a keyframe wherever it is. It
  /// may show a part of the map that the mapper does not know to be near the one before.
  void located_anew() { located_anew_ = true; }

  /// A request if the frame just located well is to become a keyframe. Of a rolling shutter it is
  /// kept back until `complete`.
  std::optional<KeyframeRequest> consider(const MapView& map, const Anchor& anchor,
                                          const std::shared_ptr<const Pyramid>& frame,
                                          const Localisation& found, const MotionModel& motion);

  /// The request kept back, one frame later: the motion during its readout is then known from both
  /// sides, to the second order, and its pose with it. None if there is none, or if the motion
  /// after it is not known.
  std::optional<KeyframeRequest> complete(const MotionModel& motion);

 private:
  void reserve_evidence();
  bool is_wanted(const MapView& map, const Anchor& anchor, const Localisation& found) const;

  struct Pending {
    KeyframeRequest request;
    Localisation found;
    geometry::Vector6d velocity;  ///< since the frame before it
    double interval_s;            ///< since then
  };

  geometry::Camera camera_;
  config::Tracking options_;
  int frames_since_keyframe_ = 0;
  bool located_anew_ = false;
  std::vector<PointEvidence> evidence_;
  std::vector<std::uint32_t> inliers_;  ///< of one frame, by index
  std::optional<Pending> pending_;
};

}  // namespace lumibox::tracking
