#pragma once

#include <vector>

#include "render/ray_cast.h"
#include "render/view.h"

namespace lumibox::render {

/// What the tests of shapes look at: a ball around S within a shell.
inline const Eigen::Vector3d kSubject = Eigen::Vector3d::Zero();

inline std::vector<lightfield::Perspective> around_a_ball(const geometry::Camera& camera,
                                                          int count = 9) {
  return test::random_capture(test::textured_ball(1.0), camera, count, 4.0, 0.3, 5);
}

inline Eigen::Vector3d ray_at(const geometry::Camera& camera, double u, double v) {
  return camera.unproject({u, v})->homogeneous();
}

inline View view_from(const Eigen::Vector3d& center) {
  return {test::make_camera(96, 72), test::look_at(center, kSubject)};
}

}  // namespace lumibox::render
