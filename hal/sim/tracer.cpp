#include "hal/sim/tracer.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>

#include "hal/newer_processors.h"
#include "hal/sim/light_bake.h"
#include "hal/sim/off_surface.h"

namespace lumibox::hal::sim {
namespace {

/// Share of unpolarised light that a surface between media reflects (Fresnel); cosines of the
/// angles to the normal on both sides, `ior` of the second medium relative to the first.
float fresnel(float cos_in, float cos_out, float ior) {
  const float parallel = (ior * cos_in - cos_out) / (ior * cos_in + cos_out);
  const float perpendicular = (cos_in - ior * cos_out) / (cos_in + ior * cos_out);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/// How much wider a pixel is on a surface that it sees at a slant: longer than wide; one round
/// footprint of its area serves.
float slant(float nx, float ny, float nz, float dx, float dy, float dz) {
  const float cosine = std::abs(nx * dx + ny * dy + nz * dz) /
                       std::sqrt((nx * nx + ny * ny + nz * nz) * (dx * dx + dy * dy + dz * dz));
  // The larger of the cosine and a twentieth, without a branch that would keep eight apart.
  const float beyond = cosine - 0.05f;
  return 1.0f / std::sqrt(0.05f + 0.5f * (beyond + std::abs(beyond)));
}

/// Pixel widths on the surfaces that a packet from one point met.
void surface_widths(const RTCRayHit8& p, float spread, float* widths) {
  for (int i = 0; i < RayPacket::kSize; ++i) {
    widths[i] = spread * p.ray.tfar[i] *
                slant(p.hit.Ng_x[i], p.hit.Ng_y[i], p.hit.Ng_z[i], p.ray.dir_x[i], p.ray.dir_y[i],
                      p.ray.dir_z[i]);
  }
}

RTCHit hit_of(const RTCHit8& hits, std::size_t i) {
  RTCHit hit{};
  hit.Ng_x = hits.Ng_x[i];
  hit.Ng_y = hits.Ng_y[i];
  hit.Ng_z = hits.Ng_z[i];
  hit.u = hits.u[i];
  hit.v = hits.v[i];
  hit.primID = hits.primID[i];
  hit.geomID = hits.geomID[i];
  return hit;
}

}  // namespace

Tracer::Tracer(const World& world, const SceneSpec& spec, const geometry::Camera& camera)
    : world_(world),
      background_(spec.background),
      reflection_depth_(spec.effects.reflection ? spec.effects.reflection->depth : 0),
      refraction_depth_(spec.effects.refraction ? spec.effects.refraction->depth : 0),
      width_(camera.width()),
      pixel_spread_(static_cast<float>(2.0 / (camera.profile().fx + camera.profile().fy))),
      camera_rays_(camera) {
  for (const LightSpec& light : spec.lights) {
    if (light.shadows == Shadows::Traced) traced_lights_.push_back(light);
  }
}

LUMIBOX_FOR_NEWER_PROCESSORS
void Tracer::trace_rows(const geometry::Pose& world_from_camera, int begin, int end,
                        LinearImage& image) {
  // A rolling shutter asks row by row; otherwise compact tiles keep a packet's rays together.
  const int rows = (end - begin) % 2 == 0 ? 2 : 1;
  const int columns = RayPacket::kSize / rows;
  const Eigen::Matrix3f rotation = world_from_camera.matrix3().cast<float>();
  const Eigen::Vector3f origin = world_from_camera.translation.cast<float>();
  RayPacket packet{};
  for (int y = begin; y < end; y += rows) {
    for (int x = 0; x < width_; x += columns) {
      const CameraRays::Tile tile{x, y, columns, rows};
      rays_.camera += camera_rays_.fill(tile, rotation, origin, packet);
      world_.intersect8(packet);
      shade_tile(tile, packet, origin, image);
    }
  }
}

void Tracer::shade_tile(const CameraRays::Tile& tile, const RayPacket& packet,
                        const Eigen::Vector3f& origin, LinearImage& image) {
  alignas(64) float widths[RayPacket::kSize];
  surface_widths(packet.rays, pixel_spread_, widths);
  const RTCRay8& rays = packet.rays.ray;
  MattePoints points;
  for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
    points.light[i] = Float4{};
    if (packet.valid[i] == 0) continue;
    const RTCHit hit = hit_of(packet.rays.hit, i);
    const Cone cone{origin, {rays.dir_x[i], rays.dir_y[i], rays.dir_z[i]}, 0.0f, pixel_spread_};
    if (is_matte(hit.geomID)) {
      meet(cone, hit, rays.tfar[i], widths[i], i, points);
    } else {
      points.light[i] = to_float4(shade(cone, hit, rays.tfar[i]));
    }
  }
  paint(points);
  for (int row = 0; row < tile.rows; ++row) {
    Color* pixels = image.row(tile.y + row) + tile.x;
    const int columns = std::min(tile.columns, width_ - tile.x);
    for (int column = 0; column < columns; ++column) {
      pixels[column] =
          to_color(points.light[static_cast<std::size_t>(row * tile.columns + column)]);
    }
  }
}

bool Tracer::is_matte(unsigned geometry_id) const {
  return geometry_id != RTC_INVALID_GEOMETRY_ID && !world_.body(geometry_id).is_optical();
}

Color Tracer::radiance(const Cone& cone) {
  ++rays_.secondary;
  RTCRayHit query{};
  query.ray.org_x = cone.origin.x();
  query.ray.org_y = cone.origin.y();
  query.ray.org_z = cone.origin.z();
  query.ray.dir_x = cone.direction.x();
  query.ray.dir_y = cone.direction.y();
  query.ray.dir_z = cone.direction.z();
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  world_.intersect1(query);
  return shade(cone, query.hit, query.ray.tfar);
}

Color Tracer::shade(const Cone& cone, const RTCHit& hit, float distance) {
  if (hit.geomID == RTC_INVALID_GEOMETRY_ID) return background_;
  const Body& body = world_.body(hit.geomID);
  const auto plain = [&] {
    const float width = (cone.width + cone.spread * distance) *
                        slant(hit.Ng_x, hit.Ng_y, hit.Ng_z, cone.direction.x(), cone.direction.y(),
                              cone.direction.z());
    return matte(cone, hit, distance, width);
  };
  if (!body.is_optical()) return plain();

  const Eigen::Vector3f point = cone.origin + distance * cone.direction;
  const Eigen::Vector3f normal = world_.normal(hit, point);
  const float width = cone.width + cone.spread * distance;
  const float curvature = body.is_exact_sphere ? 1.0f / body.radius : 0.0f;
  if (body.glass_ior > 0.0f) return through_glass(cone, body, point, normal, width, curvature);
  const Color mirrored = body.mirror * reflected(cone, point, normal, width, curvature);
  if (body.mirror == 1.0f) return mirrored;
  return mirrored + (1.0f - body.mirror) * plain();
}

Color Tracer::matte(const Cone& cone, const RTCHit& hit, float distance, float width) {
  MattePoints points;
  meet(cone, hit, distance, width, 0, points);
  paint(points);
  return to_color(points.light[0]);
}

void Tracer::meet(const Cone& cone, const RTCHit& hit, float distance, float width, std::size_t i,
                  MattePoints& points) {
  const Body& body = world_.body(hit.geomID);
  const Facet::Spot spot = body.facets[hit.primID].spot(hit.u, hit.v);
  const SurfaceTriangle& triangle = body.surface[spot.triangle];
  const auto& [at_a, step_b, step_c] = triangle.light_and_u;
  const Float4 light_and_u = at_a + spot.u * step_b + spot.v * step_c;
  points.light[i] = light_and_u;
  points.places.u[i] = light_and_u[3];
  points.places.v[i] = triangle.v[0] + spot.u * triangle.v[1] + spot.v * triangle.v[2];
  points.places.footprint[i] = width * triangle.tiles_per_metre;
  points.texture[i] = body.texture.get();
  if (!traced_lights_.empty()) {
    const Eigen::Vector3f point = cone.origin + distance * cone.direction;
    points.light[i] += to_float4(traced_light(point, world_.normal(hit, point)));
  }
}

void Tracer::paint(MattePoints& points) {
  for (std::size_t first = 0; first < points.texture.size(); ++first) {
    const Texture* texture = points.texture[first];
    if (texture == nullptr) continue;
    // All lanes at once, those of other textures in vain: mostly there are none.
    const Texture::Colors colors = texture->sample(points.places);
    for (std::size_t i = first; i < points.texture.size(); ++i) {
      if (points.texture[i] != texture) continue;
      points.light[i] *= Float4{colors.red[i], colors.green[i], colors.blue[i], 0.0f};
      points.texture[i] = nullptr;
    }
  }
}

Color Tracer::traced_light(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
  Color total = Color::Zero();
  const Eigen::Vector3f origin = off_surface(point, normal);
  for (const LightSpec& light : traced_lights_) {
    const Incoming incoming = incoming_light(light, point);
    const float cosine = normal.dot(incoming.towards_light);
    if (cosine <= 0.0f) continue;
    ++rays_.secondary;
    RTCRay ray{};
    ray.org_x = origin.x();
    ray.org_y = origin.y();
    ray.org_z = origin.z();
    ray.dir_x = incoming.towards_light.x();
    ray.dir_y = incoming.towards_light.y();
    ray.dir_z = incoming.towards_light.z();
    ray.tfar = incoming.distance;
    ray.mask = ~0u;
    if (!world_.occluded1(ray)) total += incoming.color * cosine;
  }
  return total;
}

Color Tracer::reflected(const Cone& cone, const Eigen::Vector3f& point,
                        const Eigen::Vector3f& normal, float width, float curvature) {
  if (cone.surfaces >= reflection_depth_) return background_;
  const Eigen::Vector3f direction = cone.direction.normalized();
  const float cosine = direction.dot(normal);
  const Eigen::Vector3f facing = cosine < 0.0f ? normal : Eigen::Vector3f(-normal);
  Cone next;
  next.origin = off_surface(point, facing);
  next.direction = direction - 2.0f * cosine * normal;
  next.width = width;
  next.spread = cone.spread + 2.0f * curvature * width;
  next.surfaces = cone.surfaces + 1;
  return radiance(next);
}

Color Tracer::through_glass(const Cone& cone, const Body& body, const Eigen::Vector3f& point,
                            const Eigen::Vector3f& normal, float width, float curvature) {
  const Eigen::Vector3f direction = cone.direction.normalized();
  const bool entering = direction.dot(normal) < 0.0f;
  const Eigen::Vector3f facing = entering ? normal : Eigen::Vector3f(-normal);
  const float ior = entering ? body.glass_ior : 1.0f / body.glass_ior;
  const float cos_in = -direction.dot(facing);
  const float sin2_out = (1.0f - cos_in * cos_in) / (ior * ior);  // Snell
  if (cone.surfaces >= refraction_depth_) return background_;

  Cone next;
  next.width = width;
  next.surfaces = cone.surfaces + 1;
  if (sin2_out >= 1.0f) {  // total reflection
    next.origin = off_surface(point, facing);
    next.direction = direction + 2.0f * cos_in * facing;
    next.spread = cone.spread + 2.0f * curvature * width;
    return radiance(next);
  }
  const float cos_out = std::sqrt(1.0f - sin2_out);
  next.origin = off_surface(point, -facing);
  next.direction = direction / ior + (cos_in / ior - cos_out) * facing;
  next.spread = cone.spread + std::abs(1.0f - 1.0f / ior) * curvature * width;
  const Color refracted = radiance(next) * (entering ? body.glass_tint : Color::Ones().eval());
  // What the inside of a surface reflects is faint and would double the rays at every bounce.
  if (!entering || reflection_depth_ == 0) return refracted;
  const float share = fresnel(cos_in, cos_out, ior);
  return share * reflected(cone, point, normal, width, curvature) + (1.0f - share) * refracted;
}

}  // namespace lumibox::hal::sim
