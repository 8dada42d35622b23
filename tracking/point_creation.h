#pragma once

#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "tracking/map.h"

namespace lumibox::tracking {

/// Adds points to the map from corners of keyframe `id` that show none yet: each is searched along
/// its epipolar line in nearby keyframes and triangulated (Klein and Murray, ISMAR 2007, section
/// 6.2), then looked for in the others. Returns the new points.
std::vector<PointId> create_points(const geometry::Camera& camera, const config::Tracking& options,
                                   Map& map, KeyframeId id);

/// Looks in keyframe `id` for the points of `candidates`, a view of this map, and adds the
/// sightings found: a point that many keyframes see ties them together.
void find_known_points(const geometry::Camera& camera, Map& map, KeyframeId id,
                       const MapView& candidates);

}  // namespace lumibox::tracking
