#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lightfield/perspective.h"

namespace lumibox::lightfield {

/// What surrounds a feature: SIFT's histograms of gradients (Lowe, 2004), length 512 or so.
using Descriptor = std::array<std::uint8_t, 128>;

/// Distinct places of one picture, each at the same index of all lists.
struct Features {
  std::vector<Eigen::Vector2d> pixels;    ///< in the perspective's own picture (distorted)
  std::vector<Eigen::Vector3d> bearings;  ///< unit vectors in the camera's frame
  std::vector<Descriptor> descriptors;
  /// How far a place is trusted to be where its feature is, pose and lens included: pixels of the
  /// perspective's own picture, and the angle of as much in the picture's middle.
  double tolerance_px = 0.0;
  double tolerance_rad = 0.0;
};

/// SIFT features of a perspective, at most `limit`, spread over the picture as far as it has
/// texture. A large picture is reduced first, so that the time does not grow with its size. The
/// descriptors are not turned by their own gradients but by where `up_in_world`, any fixed
/// direction, points in the picture at that place: of cameras whose poses are known that is surer,
/// and a place is one feature only.
Features find_features(const Perspective& perspective, const Eigen::Vector3d& up_in_world,
                       std::size_t limit);

}  // namespace lumibox::lightfield
