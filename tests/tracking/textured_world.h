#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "geometry/camera.h"
#include "geometry/pose.h"
#include "hal/image.h"

namespace lumibox::tracking::testing {

/// Band-limited noise: a fixed sum of waves of many directions and lengths, [0, 255].
double noise(double x, double y);

/// The same sampled once every hundredth of a unit over [-4, 4] x [-4, 4]: what walls are painted
/// with, fast enough for many pictures.
double painted(double x, double y);

/// A room corner seen by a camera at `world_from_camera`: two textured planes, z = 2 + 0.8 |x|. Its
/// edge makes it a scene that no single plane explains.
hal::Image render_wedge(const geometry::Camera& camera, const geometry::Pose& world_from_camera);

/// A painted wall z = 2 + slope . (x, y), and nothing else.
hal::Image render_wall(const geometry::Camera& camera, const geometry::Pose& world_from_camera,
                       const Eigen::Vector2d& slope);

/// The picture with a sensor's noise, grey levels, drawn from `seed`.
hal::Image with_noise(const hal::Image& image, double sigma, std::uint32_t seed);

geometry::Camera small_camera();

}  // namespace lumibox::tracking::testing
