#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "geometry/pose.h"

namespace lumibox::tracking {

/// Scene points as seen in three views or more: unit vectors in the frames of the cameras.
struct ManyViews {
  std::vector<Eigen::Vector3d> first;
  std::vector<Eigen::Vector3d> second;
  std::vector<std::vector<Eigen::Vector3d>> between;  ///< views taken between the two, in order
};

/// Decides between motions that explain two views of a plane alike (Longuet-Higgins, "The
/// reconstruction of a plane surface from two perspective projections", 1986): each gives the
/// points another shape, and only the true one fits the views between. Returns the index of the
/// candidate whose shape fits to within `noise_rad` and clearly better than any other; none if the
/// views do not tell.
std::optional<std::size_t> decide_by_third_view(
    std::span<const geometry::Pose> candidates_second_from_first, const ManyViews& views,
    double noise_rad);

}  // namespace lumibox::tracking
