#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "geometry/pose.h"
#include "hal/sim/scene_spec.h"

namespace lumibox::hal::sim {

/// Six small seeded oscillations, one per degree of freedom: a hand's tremor, a person's fidgeting.
class Wobble {
 public:
  explicit Wobble(const WobbleSpec& spec);

  /// Displacement (metres) and turn about the moved frame's own axes.
  /// `strength` scales both.
  geometry::Pose at(double time_s, double strength = 1.0) const;

 private:
  struct Wave {
    double amplitude;
    double angular_frequency;
    double phase;
  };
  std::array<std::vector<Wave>, 6> waves_;
};

/// Where the camera is and where it points over time: twice continuously differentiable, whatever
/// corners the walk has, but for the ends of a shake, where it is so once.
class HandPath {
 public:
  HandPath(const PathSpec& spec, double duration_s);

  geometry::Pose world_from_camera(double time_s) const;

 private:
  std::vector<Eigen::Vector<double, 6>> knots_;  ///< position and target every knot_spacing_s_
  double knot_spacing_s_ = 0.25;
  Wobble tremor_;
  std::optional<ShakeSpec> shake_;
  Wobble shaking_;
};

/// Camera at `position` that looks at `target` with the world's z axis upwards in the picture.
geometry::Pose look_at(const Eigen::Vector3d& position, const Eigen::Vector3d& target);

}  // namespace lumibox::hal::sim
