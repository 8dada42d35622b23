#pragma once

#include <Eigen/Core>

namespace lumibox::render {

/// Pictures are stored in sRGB (IEC 61966-2-1) and blended as light, as cameras and eyes add it up:
/// stored values 0 to 255, light 0 to 1. Bilinear samples are taken of the stored values.
double light_of(double stored);
Eigen::Vector3d light_of(const Eigen::Vector3d& stored);

/// The inverse; more light than white is white.
double stored_of(double light);

}  // namespace lumibox::render
