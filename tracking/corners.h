#pragma once

#include <Eigen/Core>
#include <vector>

#include "tracking/pyramid.h"

namespace lumibox::tracking {

struct Corner {
  Eigen::Vector2d pixel;  ///< on its own level
  int level = 0;
  float score = 0.0F;  ///< smaller eigenvalue of the structure tensor, grey levels squared
};

/// Corners of every level: FAST candidates (Rosten and Drummond, ECCV 2006) ranked by the smaller
/// eigenvalue of the structure tensor (Shi and Tomasi, CVPR 1994), at most one per square cell of
/// the level, so that they cover the picture. Best first; at most `max_count`.
std::vector<Corner> detect_corners(const Pyramid& pyramid, int fast_threshold, int max_count);

}  // namespace lumibox::tracking
