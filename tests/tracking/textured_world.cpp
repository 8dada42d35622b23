#include "tracking/textured_world.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "support/pinhole.h"

namespace lumibox::tracking::testing {

double noise(double x, double y) {
  double value = 128.0;
  std::uint32_t state = 12345;
  const auto next = [&state] {
    state = state * 1664525U + 1013904223U;
    return static_cast<double>(state >> 8) / 16777216.0;
  };
  for (int i = 0; i < 24; ++i) {
    const double direction = 2.0 * std::numbers::pi * next();
    const double wave =
        4.0 * std::pow(1.17, i);  // radians per unit, up to 148: over 4 pixels a wave
    const double phase = 2.0 * std::numbers::pi * next();
    value += 14.0 * std::sin(wave * (x * std::cos(direction) + y * std::sin(direction)) + phase);
  }
  return std::min(255.0, std::max(0.0, value));
}

double painted(double x, double y) {
  constexpr int kSide = 801;
  static const std::vector<double> table = [] {
    std::vector<double> values;
    for (int v = 0; v < kSide; ++v) {
      for (int u = 0; u < kSide; ++u) values.push_back(noise(0.01 * u - 4.0, 0.01 * v - 4.0));
    }
    return values;
  }();
  const double u = std::clamp((x + 4.0) * 100.0, 0.0, kSide - 2.0);
  const double v = std::clamp((y + 4.0) * 100.0, 0.0, kSide - 2.0);
  const auto at = static_cast<std::size_t>(static_cast<int>(v) * kSide + static_cast<int>(u));
  const double top = std::lerp(table[at], table[at + 1], u - std::floor(u));
  const double bottom = std::lerp(table[at + kSide], table[at + kSide + 1], u - std::floor(u));
  return std::lerp(top, bottom, v - std::floor(v));
}

hal::Image render_wedge(const geometry::Camera& camera, const geometry::Pose& world_from_camera) {
  hal::Image image(camera.width(), camera.height(), 1);
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      const auto n = camera.unproject(Eigen::Vector2d(u, v));
      const Eigen::Vector3d direction = world_from_camera.rotation * n->homogeneous();
      const Eigen::Vector3d& origin = world_from_camera.translation;
      double distance = 1e9;
      for (const double slope : {0.8, -0.8}) {  // z - slope x = 2, on its own side of x = 0
        const double t =
            (2.0 - origin.z() + slope * origin.x()) / (direction.z() - slope * direction.x());
        const double x = origin.x() + t * direction.x();
        if (t > 0.0 && x * slope >= 0.0) distance = std::min(distance, t);
      }
      const Eigen::Vector3d hit = origin + distance * direction;
      *image.at(u, v) = static_cast<std::uint8_t>(std::lround(painted(hit.x() * 1.28, hit.y())));
    }
  }
  return image;
}

hal::Image render_wall(const geometry::Camera& camera, const geometry::Pose& world_from_camera,
                       const Eigen::Vector2d& slope) {
  hal::Image image(camera.width(), camera.height(), 1);
  const Eigen::Vector3d normal(-slope.x(), -slope.y(), 1.0);  // normal . x = 2
  const Eigen::Vector3d& origin = world_from_camera.translation;
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      const auto n = camera.unproject(Eigen::Vector2d(u, v));
      const Eigen::Vector3d direction = world_from_camera.rotation * n->homogeneous();
      const double t = (2.0 - normal.dot(origin)) / normal.dot(direction);
      const Eigen::Vector3d hit = origin + (t > 0.0 ? t : 1e3) * direction;
      *image.at(u, v) = static_cast<std::uint8_t>(std::lround(painted(hit.x(), hit.y())));
    }
  }
  return image;
}

hal::Image with_noise(const hal::Image& image, double sigma, std::uint32_t seed) {
  hal::Image noisy = image;
  std::mt19937 generator(seed);
  std::normal_distribution<double> level(0.0, sigma);
  for (std::size_t i = 0; i < noisy.size_bytes(); ++i) {
    const double value = static_cast<double>(noisy.data()[i]) + level(generator);
    noisy.data()[i] = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
  }
  return noisy;
}

geometry::Camera small_camera() {
  return lumibox::testing::pinhole(320, 240, 270.0);
}

}  // namespace lumibox::tracking::testing
