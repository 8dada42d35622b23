#pragma once

#include <cstdint>
#include <optional>

#include "geometry/pose.h"

namespace lumibox::tracking {

enum class TrackingState {
  Initialising,  ///< no map yet
  Good,          ///< the pose can be trusted; perspectives may be recorded
  Poor,          ///< a pose, but not one to record with
  Lost,          ///< a map but no pose; relocalising
};

/// Why the state is not Good, for the screen.
enum class TrackingReason {
  None,
  TooLittleTexture,   ///< too few corners in the picture
  MoveSideways,       ///< still, or too little parallax for a first map
  TurningOnly,        ///< rotation without translation
  PlaneAmbiguous,     ///< two motions explain a flat scene
  TooDarkOrBlurred,   ///< the picture has no sharp edges
  TooFewPointsFound,  ///< the map's points are hidden or the camera looks away
  Relocalising,       ///< lost; looking for a known view
};

/// Sentence for a person, e.g. "move sideways"; empty for None.
const char* advice(TrackingReason reason);

using KeyframeId = std::int32_t;  ///< never reused; -1 is none

/// What the tracker knows of one frame when it has been tracked.
struct TrackedFrame {
  std::int64_t index = 0;         ///< of the hal::Frame
  std::int64_t timestamp_ns = 0;  ///< of the hal::Frame
  TrackingState state = TrackingState::Initialising;
  TrackingReason reason = TrackingReason::None;
  /// World as fixed at initialisation: median depth 1. None unless Good or Poor.
  std::optional<geometry::Pose> world_from_camera;
  /// A map keyframe and the pose relative to it: when the map is corrected, the corrected pose is
  /// Tracker::world_from_keyframe(keyframe) * keyframe_from_camera. Lengths are in the keyframe's
  /// own unit, that of the world when it was added: closing a loop corrects drift of scale, too.
  KeyframeId keyframe = -1;
  geometry::Pose keyframe_from_camera;
  int measurements = 0;  ///< map points found
};

}  // namespace lumibox::tracking
