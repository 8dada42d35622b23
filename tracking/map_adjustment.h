#pragma once

#include <functional>

#include "config/config.h"
#include "geometry/camera.h"
#include "tracking/map.h"

namespace lumibox::tracking {

/// Bundle adjustment of keyframe `id` with the `options.local_keyframes` - 1 keyframes that share
/// most points with it, and of the points they see; all other keyframes that see those are held
/// fixed. Sightings that do not fit are removed, and points left with fewer than two.
void adjust_locally(const geometry::Camera& camera, const config::Tracking& options, Map& map,
                    KeyframeId id);

/// The same over all keyframes but the first, which stays where it is. Asked after each step,
/// `interrupted` may end it early: what has been gained is kept, no sighting is removed, and the
/// result is false.
bool adjust_globally(const geometry::Camera& camera, const config::Tracking& options, Map& map,
                     const std::function<bool()>& interrupted = {});

}  // namespace lumibox::tracking
