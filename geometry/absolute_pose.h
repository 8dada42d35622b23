#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/pose.h"

namespace lumibox::geometry {

struct AbsolutePose {
  Pose camera_from_world;
  std::vector<bool> inliers;  ///< for each point, whether its angular error is within bounds
  int inlier_count = 0;
};

/// Pose of a camera that sees points_in_world[i] along the unit vector bearings[i], with outliers:
/// P3P in RANSAC, then refinement of the angular errors of the inliers. `max_error_rad` is the
/// angle up to which a point counts as seen. None for fewer than four points, if the spans differ
/// in length, or if fewer than four points agree on any pose. Same input and seed, same result.
std::optional<AbsolutePose> solve_absolute_pose(std::span<const Eigen::Vector3d> points_in_world,
                                                std::span<const Eigen::Vector3d> bearings,
                                                double max_error_rad, std::uint32_t seed);

/// The pose nearest to `start` that minimises the squared angular errors of the points flagged in
/// `use` (Levenberg-Marquardt). Returns `start` where fewer than three points are flagged.
Pose refine_absolute_pose(const Pose& start, std::span<const Eigen::Vector3d> points_in_world,
                          std::span<const Eigen::Vector3d> bearings, const std::vector<bool>& use);

}  // namespace lumibox::geometry
