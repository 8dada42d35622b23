#pragma once

#include <Eigen/Core>

namespace lumibox::geometry {

/// One scene point as seen from two cameras: unit vectors, each in the frame of its camera.
struct BearingPair {
  Eigen::Vector3d first;
  Eigen::Vector3d second;
};

}  // namespace lumibox::geometry
