#pragma once

#include <span>
#include <vector>

#include "geometry/bearing_pair.h"
#include "geometry/pose.h"

namespace lumibox::geometry {

/// The motion nearest to `start`, translation of unit length, that minimises the squared Sampson
/// errors (see essential_error2) of the pairs flagged in `use`: Levenberg-Marquardt over three
/// degrees of rotation and two of the translation's direction. `start` where fewer than five pairs
/// are flagged.
Pose refine_motion(const Pose& start, std::span<const BearingPair> pairs,
                   const std::vector<bool>& use, int max_iterations);

}  // namespace lumibox::geometry
