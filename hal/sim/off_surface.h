#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace lumibox::hal::sim {

/// Where a ray that leaves a surface begins: off it, beyond the rounding of its coordinates, on the
/// side that the unit `normal` points to. Metres.
inline Eigen::Vector3f off_surface(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
  return point + 3e-5f * std::max(1.0f, point.cwiseAbs().maxCoeff()) * normal;
}

}  // namespace lumibox::hal::sim
