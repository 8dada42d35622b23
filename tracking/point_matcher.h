#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "geometry/camera.h"
#include "geometry/pose.h"
#include "tracking/map_view.h"
#include "tracking/patch.h"

namespace lumibox::tracking {

/// How to look for a map point in a picture: the sighting to compare with, and
/// the warp from it (Klein and Murray, ISMAR 2007, section 5.3).
struct PatchWarp {
  const Pyramid* source = nullptr;
  Eigen::Vector2d source_pixel;        ///< on source_level
  int source_level = 0;                ///< of the template
  int target_level = 0;                ///< level to search on, where the patch keeps its size
  Eigen::Matrix2d source_from_target;  ///< offsets on target_level to offsets on source_level
};

/// Picks a sighting from which the point looks as it does from `camera_from_world`, and the
/// warp from a plane through the point that faces the sighting's camera. With `min_level` above 0
/// the search is on that level or a coarser one. None if the point is seen from an angle or scale
/// at which a patch cannot be compared.
std::optional<PatchWarp> plan_warp(const geometry::Camera& camera, const MapView& map,
                                   const Eigen::Vector3d& position,
                                   std::span<const Sighting> sightings,
                                   const geometry::Pose& camera_from_world, int min_level);

/// Affine map from offsets around a point's picture in one keyframe to offsets in a picture taken
/// from `target_from_source`, both on level 0, for the plane through the point that faces the
/// source camera: the derivative of one projection by the other. None if either does not see the
/// point.
std::optional<Eigen::Matrix2d> affine_warp(const geometry::Camera& camera,
                                           const Eigen::Vector3d& point_in_source,
                                           const geometry::Pose& target_from_source);

/// Correlation below which a patch is not the same: found once by looking at true and false
/// matches on simulated scenes; the rest of the outliers is the M-estimator's business.
inline constexpr double kMinCorrelation = 0.75;

}  // namespace lumibox::tracking
