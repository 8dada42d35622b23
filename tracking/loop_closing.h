#pragma once

#include "geometry/camera.h"
#include "tracking/covisibility.h"
#include "tracking/loop_detector.h"
#include "tracking/map.h"

namespace lumibox::tracking {

/// Brings together the two parts of the map that a loop found to be the same place: spreads the
/// drift over the keyframes on the way by a pose graph of similarities (Strasdat, Montiel and
/// Davison, RSS 2010), moves each point with the keyframe that saw it first, and makes one point of
/// two that are the same. Keyframe 0 stays. What is left is for an adjustment of the whole map.
/// False, with nothing changed, if the drift could not be spread. `covisibility` joins what is
/// kConnected.
bool close_loop(Map& map, const CovisibilityGraph& covisibility, const Loop& loop);

/// Makes one point of two that keyframe `id` sees in the same place at the same depth; the older
/// stays. Returns how many points went.
int merge_duplicates(Map& map, KeyframeId id);

/// Whether keyframe `id` sees points of another that is near, but was far along the walk, small
/// step by small step, until now: an orbit that came back to its own points, which needs no
/// correction but is a loop all the same. Walking back the way one came is none.
bool has_met_itself(const Map& map, const CovisibilityGraph& graph, KeyframeId id);

}  // namespace lumibox::tracking
