#pragma once

#include <span>
#include <vector>

#include "lightfield/track_triangulation.h"

namespace lumibox::lightfield {

/// Takes out the points that few views agree on and that lie at another depth than what is seen
/// around them: of those, most are matches of different things that happen to meet, as edges behind
/// one another, reflections and patterns that repeat make them. A point in a gap between others is
/// kept if enough views have seen it there.
std::vector<TrackPoint> without_lonely_points(std::span<const View> views,
                                              const std::vector<TrackPoint>& points);

}  // namespace lumibox::lightfield
