#pragma once

#include "config/config.h"
#include "geometry/pose.h"
#include "tracking/map_tracking.h"

namespace lumibox::tracking {

/// How far the pose of a located frame can be trusted.
enum class Trust {
  None,    ///< too few points: any pose
  Little,  ///< a pose, but too little of the map shows for it to be the place
  Place,   ///< it is the place: the map may grow from it, but the pose is held loosely
  Full,    ///< perspectives may be recorded
};

/// Judges by the number of points found, their share of those expected, and how well together they
/// hold the camera's place.
Trust trust_in(const Localisation& found, const config::Tracking& options);

/// Whether a hand that went on as it did could be where it was found instead, one frame later.
/// Somebody walking past covers the map, and moves the small images: what little then agrees on a
/// pose may agree on any.
bool is_within_reach(const geometry::Pose& found_from_expected, double depth);

}  // namespace lumibox::tracking
