#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/camera.h"
#include "tracking/initialiser.h"

namespace lumibox::tracking {

/// Where one point of the initial map was seen in every frame from the first view to the second,
/// pixels of level 0.
using PointPath = std::vector<Eigen::Vector2d>;

/// Takes the rolling shutter out of an initial map. Two views alone cannot tell a sheared scene
/// from a camera that moves while it reads; the frames between them tell how it moved. In turns:
/// the motion during each readout from the poses of the frames beside it, then all poses and points
/// with those motions held. `times_ns` and every path have one entry per frame.
void correct_for_readout(const geometry::Camera& camera, std::span<const std::int64_t> times_ns,
                         std::span<const PointPath> paths, InitialMap& map);

}  // namespace lumibox::tracking
