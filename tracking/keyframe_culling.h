#pragma once

#include "config/config.h"
#include "tracking/map.h"

namespace lumibox::tracking {

/// Takes keyframes out of the map that are there twice: an older one stands next to them and looks
/// the same way, and nearly all of their points are seen by three others from as near (Mur-Artal,
/// Montiel and Tardós, "ORB-SLAM", IEEE T-RO 2015, section VI.E). A hand that comes back and an
/// orbit that closes leave such pairs; a place without a keyframe is never made, for the tracker
/// would ask for one again. Looked at are those that share points with `newest`, but for the few
/// that are as new. Returns how many went.
int cull_keyframes(const config::Tracking& options, Map& map, KeyframeId newest);

}  // namespace lumibox::tracking
