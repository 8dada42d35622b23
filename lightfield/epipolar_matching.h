#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/pose.h"
#include "lightfield/features.h"

namespace lumibox::lightfield {

/// Features a[first] and b[second] that look alike and whose rays may meet.
using Match = std::pair<std::size_t, std::size_t>;

/// Matches between the features of two perspectives, by ascending `first`; every feature is in one
/// at most. A match lies in one epipolar plane to the tolerance, before both cameras or at
/// infinity, is much more alike than any other place along the line (Lowe's ratio), and is the best
/// from either side: texture that repeats along the line gives none. None without a baseline; and
/// none near the epipoles, where nothing has depth.
std::vector<Match> match_along_epipolar_lines(const Features& a, const geometry::Pose& world_from_a,
                                              const Features& b,
                                              const geometry::Pose& world_from_b);

}  // namespace lumibox::lightfield
