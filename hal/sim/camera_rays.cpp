#include "hal/sim/camera_rays.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "hal/newer_processors.h"

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
  const Eigen::Matrix3f r = world_from_camera;
  const Eigen::Vector3f start = origin;
  const int column_bits = std::countr_zero(static_cast<unsigned>(tile.columns));
  std::array<float, RayPacket::kSize> x;
  std::array<float, RayPacket::kSize> y;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const int row = static_cast<int>(i) >> column_bits;
    const int column = static_cast<int>(i) & (tile.columns - 1);
    const auto pixel = static_cast<std::size_t>((tile.y + row) * stride_ + tile.x + column);
    x[i] = bearing_x_[pixel];
    y[i] = bearing_y_[pixel];
  }
  RTCRay8& ray = packet.rays.ray;
  int valid = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    packet.valid[i] = -static_cast<int>(!std::isnan(x[i]));
    valid += static_cast<int>(!std::isnan(x[i]));
    ray.org_x[i] = start.x();
    ray.org_y[i] = start.y();
    ray.org_z[i] = start.z();
    ray.dir_x[i] = r(0, 0) * x[i] + r(0, 1) * y[i] + r(0, 2);
    ray.dir_y[i] = r(1, 0) * x[i] + r(1, 1) * y[i] + r(1, 2);
    ray.dir_z[i] = r(2, 0) * x[i] + r(2, 1) * y[i] + r(2, 2);
    ray.tnear[i] = 0.0f;
    ray.tfar[i] = std::numeric_limits<float>::infinity();
    ray.mask[i] = ~0u;
    packet.rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  return valid;
}

}  // namespace lumibox::hal::sim
