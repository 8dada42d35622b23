#pragma once

#include <cstddef>
#include <cstdint>
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
  geometry::Camera camera;              ///< pinhole; its pixels are the grid, here row by row
  float largest = 0.0F;                 ///< inverse depth in the map
  std::vector<std::uint16_t> shares;    ///< inverse depths, 65535 for the largest
  std::vector<std::uint8_t> agreement;  ///< confidences, 255 for 1; never 0

  /// Rounds: three bytes a sample, or some hundred maps would take more than all else does.
  /// Precondition: one of each for every pixel of the camera, at least one.
  DepthMap(const geometry::Camera& camera, const std::vector<float>& inverse_depths,
           const std::vector<float>& confidences);

  std::size_t size() const { return shares.size(); }

  /// Along the optical axis, 1 / world units; not negative.
  float inverse_depth(std::size_t i) const {
    return largest * (static_cast<float>(shares[i]) / 65535.0F);
  }

  /// How well the pictures agree there, (0, 1].
  float confidence(std::size_t i) const { return static_cast<float>(agreement[i]) / 255.0F; }

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
