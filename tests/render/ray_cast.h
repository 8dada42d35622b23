#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/camera.h"
#include "hal/image.h"
#include "lightfield/perspective.h"

namespace lumibox::test {

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

/// Colour (0..1 per channel) that a ray sees.
using World = std::function<Eigen::Vector3d(const Ray&)>;

/// A smooth coloured pattern on the plane through `point` with this normal; black beside it.
World textured_plane(const Eigen::Vector3d& point, const Eigen::Vector3d& normal);

/// A textured ball around the origin before a textured shell of ten times the radius.
World textured_ball(double radius);

/// What the camera sees, one ray through each pixel centre; black where no ray reaches the pixel.
hal::Image photograph(const World& world, const geometry::Camera& camera,
                      const geometry::Pose& world_from_camera);

/// A camera at `center` looking at `target`, its x axis level with y down before `roll` is applied.
geometry::Pose look_at(const Eigen::Vector3d& center, const Eigen::Vector3d& target,
                       double roll = 0.0);

/// Camera of 60 degrees field of view, `distorted` with a wide-angle lens's coefficients.
geometry::Camera make_camera(int width, int height, bool distorted = false);

/// A fisheye lens that sees 120 degrees across the width.
geometry::Camera make_fisheye_camera(int width, int height);

lightfield::Perspective photograph_perspective(int id, const World& world,
                                               const geometry::Camera& camera,
                                               const geometry::Pose& world_from_camera);

/// `count` perspectives at random places of a cap of half angle `spread` (radians) around -z, about
/// `distance` from the origin, looking near it. The same seed gives the same ones.
std::vector<lightfield::Perspective> random_capture(const World& world,
                                                    const geometry::Camera& camera, int count,
                                                    double distance, double spread,
                                                    std::uint32_t seed);

}  // namespace lumibox::test
