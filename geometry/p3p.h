#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/pose.h"

namespace lumibox::geometry {

/// Poses camera_from_world (at most four) from which three points are seen along three unit
/// bearings. Grunert's equations for the three distances are two conics whose pencil holds a pair
/// of lines; each line meets either conic in two points (the idea of Persson and Nordberg, "Lambda
/// Twist", ECCV 2018). Every returned pose sees all points in front and along their bearings to
/// 1e-6 rad. Empty for collinear points, repeated points or repeated bearings.
std::vector<Pose> solve_p3p(const std::array<Eigen::Vector3d, 3>& points_in_world,
                            const std::array<Eigen::Vector3d, 3>& bearings);

}  // namespace lumibox::geometry
