#include "tracking/tracked_frame.h"

namespace lumibox::tracking {

const char* advice(TrackingReason reason) {
  switch (reason) {
    case TrackingReason::None:
      return "";
    case TrackingReason::TooLittleTexture:
      return "too little texture: show more of the surroundings";
    case TrackingReason::MoveSideways:
      return "move sideways";
    case TrackingReason::TurningOnly:
      return "turning only: move sideways";
    case TrackingReason::PlaneAmbiguous:
      return "flat scene: keep moving";
    case TrackingReason::TooDarkOrBlurred:
      return "too dark or blurred";
    case TrackingReason::TooFewPointsFound:
      return "point back at the subject";
    case TrackingReason::Relocalising:
      return "lost: return to a place seen before";
  }
  return "";
}

}  // namespace lumibox::tracking
