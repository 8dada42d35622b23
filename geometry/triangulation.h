#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "geometry/pose.h"

namespace lumibox::geometry {

/// Smallest angle between two rays, in radians, at which a point is still triangulated. At a tenth
/// of it the depth of a point seen to 1e-3 of a pixel would be noise only.
inline constexpr double kMinTriangulationAngle = 1e-7;

/// The point seen along `bearing_a` by camera a and along `bearing_b` by camera b, in the world's
/// frame. Bearings are unit vectors in the frame of their camera. The point minimises the sum of
/// the sines of the angular errors (closed form of Lee and Civera, "Closed-form optimal two-view
/// triangulation based on angular errors", ICCV 2019); for rays that meet it is exact.
/// None if the rays are parallel to kMinTriangulationAngle, the centres coincide, the point lies
/// behind either camera, or any input is not finite.
std::optional<Eigen::Vector3d> triangulate(const Pose& a_from_world, const Pose& b_from_world,
                                           const Eigen::Vector3d& bearing_a,
                                           const Eigen::Vector3d& bearing_b);

/// The point seen by several cameras, bearings[i] a unit vector in the frame of camera i: the two
/// rays that differ most give the start, Levenberg-Marquardt on the angular errors of all the rest.
/// None on the same conditions as above, for fewer than two rays, or if the spans differ in length.
std::optional<Eigen::Vector3d> triangulate(std::span<const Pose> cameras_from_world,
                                           std::span<const Eigen::Vector3d> bearings);

/// Angle in radians at `point_in_world` between the directions to the two cameras' centres.
double parallax_angle(const Pose& a_from_world, const Pose& b_from_world,
                      const Eigen::Vector3d& point_in_world);

}  // namespace lumibox::geometry
