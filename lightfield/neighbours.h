#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "lightfield/perspective.h"

namespace lumibox::lightfield {

/// Pairs of perspectives that are likely to see the same, (smaller index, larger index), ascending;
/// about eight for each perspective, however many there are. Near in place and in direction, and
/// looking no more than 60 degrees apart; not only the very nearest, which in a video have no
/// parallax. Perspectives at one place are no pair.
std::vector<std::pair<std::size_t, std::size_t>> neighbouring_pairs(
    const std::vector<Perspective>& perspectives);

}  // namespace lumibox::lightfield
