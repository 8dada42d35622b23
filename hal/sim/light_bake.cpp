#include "hal/sim/light_bake.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "hal/sim/off_surface.h"

namespace lumibox::hal::sim {
namespace {

constexpr std::size_t kPacket = 8;

/// Two unit vectors perpendicular to a unit vector and to each other.
std::array<Eigen::Vector3f, 2> tangents(const Eigen::Vector3f& axis) {
  const Eigen::Vector3f u = axis.unitOrthogonal();
  return {u, axis.cross(u)};
}

/// `count` points spread evenly over the unit disc (Vogel's spiral, Math. Biosciences 1979).
Eigen::Vector2f spiral(std::size_t i, std::size_t count) {
  const float radius = std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(count));
  const float angle = static_cast<float>(i) * std::numbers::pi_v<float> * (3.0f - std::sqrt(5.0f));
  return radius * Eigen::Vector2f(std::cos(angle), std::sin(angle));
}

/// Share of eight directions in which nothing stands nearer than `reach`.
float visible_share(RTCScene scene, const Eigen::Vector3f& origin,
                    std::span<const Eigen::Vector3f, kPacket> directions, float reach) {
  alignas(32) RTCRay8 rays{};
  alignas(32) std::array<int, kPacket> valid{};
  valid.fill(-1);
  for (std::size_t i = 0; i < kPacket; ++i) {
    rays.org_x[i] = origin.x();
    rays.org_y[i] = origin.y();
    rays.org_z[i] = origin.z();
    rays.dir_x[i] = directions[i].x();
    rays.dir_y[i] = directions[i].y();
    rays.dir_z[i] = directions[i].z();
    rays.tnear[i] = 0.0f;
    rays.tfar[i] = reach;
    rays.mask[i] = ~0u;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded8(valid.data(), scene, &context, &rays);
  int visible = 0;
  for (std::size_t i = 0; i < kPacket; ++i) visible += rays.tfar[i] >= 0.0f ? 1 : 0;
  return static_cast<float>(visible) / kPacket;
}

/// Share of the sky, weighted by the cosine, that is open within the light's reach.
float open_sky(RTCScene scene, const Eigen::Vector3f& origin, const Eigen::Vector3f& normal,
               float reach) {
  constexpr std::size_t kDirections = 5 * kPacket;
  const auto [u, v] = tangents(normal);
  float open = 0.0f;
  std::array<Eigen::Vector3f, kPacket> directions;
  for (std::size_t first = 0; first < kDirections; first += kPacket) {
    for (std::size_t i = 0; i < kPacket; ++i) {
      // Even on the disc is cosine-weighted on the hemisphere above it (Malley's method).
      const Eigen::Vector2f p = spiral(first + i, kDirections);
      const float up = std::sqrt(std::max(0.0f, 1.0f - p.squaredNorm()));
      directions[i] = p.x() * u + p.y() * v + up * normal;
    }
    open += visible_share(scene, origin, directions, reach);
  }
  return open * static_cast<float>(kPacket) / static_cast<float>(kDirections);
}

float unshadowed(RTCScene scene, const LightSpec& light, const Eigen::Vector3f& origin,
                 const Incoming& incoming) {
  constexpr std::size_t kDirections = 2 * kPacket;
  const float spread = std::tan(static_cast<float>(light.softness_deg * std::numbers::pi / 180.0));
  const auto [u, v] = tangents(incoming.towards_light);
  float visible = 0.0f;
  std::array<Eigen::Vector3f, kPacket> directions;
  for (std::size_t first = 0; first < kDirections; first += kPacket) {
    for (std::size_t i = 0; i < kPacket; ++i) {
      const Eigen::Vector2f p = spread * spiral(first + i, kDirections);
      directions[i] = incoming.towards_light + p.x() * u + p.y() * v;
    }
    visible += visible_share(scene, origin, directions, incoming.distance);
  }
  return visible * static_cast<float>(kPacket) / static_cast<float>(kDirections);
}

}  // namespace

Incoming incoming_light(const LightSpec& light, const Eigen::Vector3f& point) {
  if (light.kind == LightKind::Directional) {
    return {-light.direction.cast<float>(), std::numeric_limits<float>::infinity(), light.color};
  }
  const Eigen::Vector3f to_light = light.position.cast<float>() - point;
  const float distance = std::max(to_light.norm(), 1e-6f);
  const float nominal = static_cast<float>(light.falloff_m) / distance;
  return {to_light / distance, distance, light.color * (nominal * nominal)};
}

Color baked_light(RTCScene scene, const std::vector<LightSpec>& lights,
                  const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
  const Eigen::Vector3f origin = off_surface(point, normal);
  Color total = Color::Zero();
  for (const LightSpec& light : lights) {
    if (light.shadows == Shadows::Traced) continue;
    const bool shadowed = light.shadows == Shadows::Baked;
    if (light.kind == LightKind::Ambient) {
      const auto reach = static_cast<float>(light.reach_m);
      total += light.color * (shadowed ? open_sky(scene, origin, normal, reach) : 1.0f);
      continue;
    }
    const Incoming incoming = incoming_light(light, point);
    const float cosine = normal.dot(incoming.towards_light);
    if (cosine <= 0.0f) continue;
    total +=
        incoming.color * cosine * (shadowed ? unshadowed(scene, light, origin, incoming) : 1.0f);
  }
  return total;
}

}  // namespace lumibox::hal::sim
