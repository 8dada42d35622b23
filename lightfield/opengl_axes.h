#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/pose.h"

namespace lumibox::lightfield {

/// Camera-to-world matrix with OpenGL's camera axes (x right, y up, z backward), as nerfstudio and
/// instant-ngp want it.
Eigen::Matrix4d world_from_opengl(const geometry::Pose& world_from_camera);

/// The inverse, for a matrix whose upper left part is within `tolerance` (largest element of
/// R^T R - I) of a rotation; the nearest rotation is taken. None if it is not, or the last row is
/// not 0 0 0 1.
std::optional<geometry::Pose> pose_from_opengl(const Eigen::Matrix4d& world_from_opengl,
                                               double tolerance);

}  // namespace lumibox::lightfield
