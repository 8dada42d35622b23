#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <vector>

#include "geometry/camera.h"

namespace lumibox::hal::sim {

/// Eight rays, which is what Embree follows together in AVX2 registers; valid is -1 or 0 per ray.
struct RayPacket {
  static constexpr int kSize = 8;
  alignas(64) int valid[kSize];
  alignas(64) RTCRayHit8 rays;
};

/// The rays of a camera's pixels through its exact model, one packet per tile of neighbours: they
/// meet the same surfaces, which is what makes packets quick.
class CameraRays {
 public:
  /// Pixels [x, x + columns) x [y, y + rows); columns * rows is RayPacket::kSize and
  /// columns a power of two. Columns may reach
  /// beyond the picture's edge.
  struct Tile {
    int x;
    int y;
    int columns;
    int rows;
  };

  explicit CameraRays(const geometry::Camera& camera);

  /// Rays of a tile in row-major order, ready to be intersected. Not valid are those beyond the
  /// edge and where the lens shows nothing. Gives the number of valid ones.
  int fill(const Tile& tile, const Eigen::Matrix3f& world_from_camera,
           const Eigen::Vector3f& origin, RayPacket& packet) const;

 private:
  std::ptrdiff_t stride_;  ///< of a row, whole packets
  /// Per pixel, on z = 1; NaN where there is no ray.
  std::vector<float> bearing_x_;
  std::vector<float> bearing_y_;
};

}  // namespace lumibox::hal::sim
