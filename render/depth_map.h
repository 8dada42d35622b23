#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/camera.h"
#include "lightfield/perspective.h"

namespace lumibox::render {

/// The scene's shape as a perspective sees it, in its camera's frame, on a grid much coarser than
/// its picture.
struct DepthMap {
  geometry::Camera camera;           ///< pinhole; its pixels are the grid
  std::vector<float> inverse_depth;  ///< along the optical axis, 1 / world units, row by row
  std::vector<float> confidence;     ///< (0, 1]: how well the pictures agree there

  /// Inverse depth that is seen along a ray in the camera's frame, in front of it.
  double along(const Eigen::Vector3d& ray) const;
};

/// Angle at S to `center`, radians, and index of all perspectives that can be shown; the nearest
/// first.
std::vector<std::pair<double, std::size_t>> nearest_by_angle(
    const std::vector<lightfield::Perspective>& perspectives, const Eigen::Vector3d& center,
    const Eigen::Vector3d& focus);

/// Indices of the perspectives whose pictures tell the depth in that of `index`: the nearest by
/// angle at S that lie far enough away for parallax; at most four.
std::vector<std::size_t> depth_neighbours(const std::vector<lightfield::Perspective>& perspectives,
                                          std::size_t index, const Eigen::Vector3d& focus);

/// Depth of a perspective's pixels from the pictures of others, by a plane sweep; `focus` is what
/// lies in the middle of the range searched. Others whose picture is lost count for nothing;
/// without others everything is as far as the focus. None if its own picture is lost.
std::optional<DepthMap> estimate_depth(const lightfield::Perspective& perspective,
                                       const std::vector<const lightfield::Perspective*>& others,
                                       const Eigen::Vector3d& focus);

}  // namespace lumibox::render
