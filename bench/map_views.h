#pragma once

#include <vector>

#include "bench/svg.h"
#include "bench/track_plot.h"
#include "geometry/pose.h"

namespace lumibox::bench {

/// Turn from a world to axes that a person expects of a map: x to the right, y ahead of the first
/// camera, z up. Up is the direction most at right angles to all cameras' x axes, since a hand
/// holds a camera level, and of these the one that the cameras' own up is nearest to; the mean of
/// their own if they were not held level.
Eigen::Matrix3d map_from_world(const std::vector<hal::StampedPose>& trajectory);

/// Draws the map of `plot`, whose poses all are in one world by now, from above and from the side.
/// `unit` is that of the world. `corner` and `size` are of the room for both views.
void draw_map_views(Svg& svg, const TrackPlot& plot, const std::string& unit,
                    const Vector2d& corner, const Vector2d& size);

}  // namespace lumibox::bench
