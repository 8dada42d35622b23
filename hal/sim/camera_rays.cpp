#include "hal/sim/camera_rays.h"

#include <bit>
#include <cmath>
#include <limits>

#include "hal/sim/newer_processors.h"

namespace lumibox::hal::sim {

CameraRays::CameraRays(const geometry::Camera& camera)
    : stride_((camera.width() + RayPacket::kSize - 1) / RayPacket::kSize * RayPacket::kSize) {
  const auto pixels = static_cast<std::size_t>(stride_ * camera.height());
  bearing_x_.assign(pixels, std::numeric_limits<float>::quiet_NaN());
  bearing_y_ = bearing_x_;
  for (int y = 0; y < camera.height(); ++y) {
    for (int x = 0; x < camera.width(); ++x) {
      const auto bearing = camera.unproject({x, y});
      if (!bearing) continue;
      const auto pixel = static_cast<std::size_t>(y * stride_ + x);
      bearing_x_[pixel] = static_cast<float>(bearing->x());
      bearing_y_[pixel] = static_cast<float>(bearing->y());
    }
  }
}

LUMIBOX_FOR_NEWER_PROCESSORS
int CameraRays::fill(const Tile& tile, const Eigen::Matrix3f& world_from_camera,
                     const Eigen::Vector3f& origin, RayPacket& packet) const {
  const Eigen::Matrix3f& r = world_from_camera;
  RTCRay8& ray = packet.rays.ray;
  const int column_bits = std::countr_zero(static_cast<unsigned>(tile.columns));
  int valid = 0;
  for (int i = 0; i < RayPacket::kSize; ++i) {
    const int row = i >> column_bits;
    const int column = i & (tile.columns - 1);
    const auto pixel = static_cast<std::size_t>((tile.y + row) * stride_ + tile.x + column);
    const float x = bearing_x_[pixel];
    const float y = bearing_y_[pixel];
    packet.valid[i] = -static_cast<int>(!std::isnan(x));
    valid -= packet.valid[i];
    ray.org_x[i] = origin.x();
    ray.org_y[i] = origin.y();
    ray.org_z[i] = origin.z();
    ray.dir_x[i] = r(0, 0) * x + r(0, 1) * y + r(0, 2);
    ray.dir_y[i] = r(1, 0) * x + r(1, 1) * y + r(1, 2);
    ray.dir_z[i] = r(2, 0) * x + r(2, 1) * y + r(2, 2);
    ray.tnear[i] = 0.0f;
    ray.tfar[i] = std::numeric_limits<float>::infinity();
    ray.mask[i] = ~0u;
    packet.rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  return valid;
}

}  // namespace lumibox::hal::sim
