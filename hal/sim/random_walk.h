#pragma once

#include "hal/sim/random.h"
#include "hal/sim/random_scene.h"

namespace lumibox::hal::sim {

/// How far a walk keeps from what it goes around, and within which angles.
struct WalkRoom {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector2d radius_m{0.5, 0.8};         ///< least and most
  Eigen::Vector2d elevation_deg{12.0, 55.0};  ///< least and most, seen from the target
  Eigen::Vector2d extent_deg{60.0, 180.0};    ///< of an arc, least and most
  int most_sweeps = 4;                        ///< of an arc
  bool from_the_front = false;                ///< an arc's middle is at azimuth 0
};

struct RandomWalk {
  PathSpec path;
  double duration_s = 0.0;
};

/// A walk as a hand makes it: at a speed that varies, with tremor, with or without a step sideways
/// first.
RandomWalk random_walk(Walk walk, const WalkRoom& room, Random& random);

}  // namespace lumibox::hal::sim
