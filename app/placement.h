#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "geometry/pose.h"
#include "lightfield/perspective.h"

namespace lumibox::app {

/// A ray in the world on which the subject is looked for (thesis 2.2).
struct Ray {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< in world
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< in world, unit length
};

/// The pixel in the middle of the picture.
Eigen::Vector2d reticle(const geometry::Camera& camera);

/// Ray of a pixel; none where the camera model has no undistorted point for it.
std::optional<Ray> ray_of_pixel(const geometry::Camera& camera,
                                const geometry::Pose& world_from_camera,
                                const Eigen::Vector2d& pixel);

/// Depth along the ray, in world units, of the tracked points around it: the median over those that
/// make the smallest angle with it. None if there are too few in front of the ray's origin.
std::optional<double> depth_on_ray(const Ray& ray, const std::vector<Eigen::Vector3d>& points);

/// `depth` moved by `steps`, each of which changes the inverse depth by the share `depth_step`, so
/// that near and far steps look alike in the picture. Positive steps go away from the camera, and
/// as many back give the same depth again.
double slide_depth(double depth, int steps, double depth_step);

/// The sphere of thesis 2.2 on a ray at a depth.
lightfield::Sphere sphere_on_ray(const Ray& ray, double depth, const config::Capture& options);

}  // namespace lumibox::app
