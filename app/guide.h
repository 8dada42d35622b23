#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/pose.h"
#include "lightfield/coverage.h"
#include "lightfield/light_field.h"

namespace lumibox::app {

/// Knows what a capture still lacks. It is worked out anew only when something has changed.
class Guide {
 public:
  /// `widest_gap` that is to be filled, radians.
  explicit Guide(double widest_gap) : widest_gap_(widest_gap) {}

  /// For a gate of `threshold` radians. Nothing is missing without a subject.
  const lightfield::Holes& holes(const lightfield::LightField& light_field, double threshold);

 private:
  double widest_gap_;
  lightfield::HoleFinder finder_;
  std::vector<Eigen::Vector3d> directions_;
  double threshold_ = 0.0;
  lightfield::Holes holes_;
};

/// The direction on its own screen, right and down, unit, in which a camera must be moved to get to
/// `direction` (unit, in world, from S) on the shortest way around S. None if it is there, to
/// `tolerance` radians, or if that way leads along its line of sight.
std::optional<Eigen::Vector2d> way_to(const Eigen::Vector3d& direction,
                                      const geometry::Pose& world_from_camera,
                                      const Eigen::Vector3d& subject, double tolerance);

}  // namespace lumibox::app
