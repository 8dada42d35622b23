#pragma once

#include <numbers>

#include "geometry/pose.h"
#include "geometry/position.h"

/// What a keyframe in a map file may be. Nothing beyond is written, so that all that is can be
/// read.
namespace lumibox::lightfield {

/// Of what closed loops have multiplied lengths by, and its inverse; no drift comes near it.
inline constexpr double kLargestScale = 1e3;

/// Of the way during a readout, in median depths of what is seen: far faster than pictures are of
/// any use.
inline constexpr double kLargestReadoutWay = 1e3;

inline bool is_length(double value) {
  return value > 0.0 && value <= geometry::kLargestCoordinate;
}

inline bool is_scale(double value) {
  return value >= 1.0 / kLargestScale && value <= kLargestScale;
}

/// `twist` has the translation first.
inline bool is_readout_motion(const geometry::Vector6d& twist, double median_depth) {
  return twist.head<3>().stableNorm() <= kLargestReadoutWay * median_depth &&
         twist.tail<3>().stableNorm() <= std::numbers::pi;
}

}  // namespace lumibox::lightfield
