#include "hal/sim/world.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "config/error.h"
#include "hal/sim/exact_sphere.h"
#include "hal/sim/light_bake.h"
#include "hal/sim/patterns.h"

namespace lumibox::hal::sim {
namespace {

/// The mesh moved to its place in the world.
void place(Mesh& mesh, const geometry::Pose& world_from_object) {
  const Eigen::Matrix3f rotation = world_from_object.matrix3().cast<float>();
  const Eigen::Vector3f translation = world_from_object.translation.cast<float>();
  for (Eigen::Vector3f& p : mesh.positions) p = rotation * p + translation;
  for (Eigen::Vector3f& n : mesh.normals) n = rotation * n;
}

/// An occluder is a plain ellipsoid that stands where its passage begins.
ObjectSpec occluder_object(const OccluderSpec& spec) {
  ObjectSpec object;
  object.shape = Shape::Sphere;
  object.size = spec.size;
  object.segments = 24;
  object.world_from_object.translation = spec.from;
  object.texture = spec.texture;
  return object;
}

bool is_ball(const ObjectSpec& spec) {
  return spec.shape == Shape::Sphere && spec.size.minCoeff() == spec.size.maxCoeff() &&
         spec.displacement.amplitude_m == 0.0;
}

}  // namespace

World::World(const SceneSpec& spec)
    // One thread: renders must not depend on how many cores there are.
    : device_(rtcNewDevice("threads=1,set_affinity=0"), rtcReleaseDevice),
      fixed_(nullptr, rtcReleaseScene),
      moving_(nullptr, rtcReleaseScene) {
  if (!device_) throw config::InputError("Embree: cannot open its device on this processor");
  fixed_.reset(rtcNewScene(device_.get()));
  moving_.reset(rtcNewScene(device_.get()));
  // Not robust: one ray in some millions slips through the edge between two triangles, a pixel in
  // ten pictures, and a picture takes a sixth less time.
  rtcSetSceneFlags(moving_.get(), RTC_SCENE_FLAG_DYNAMIC);

  const EffectSpecs& effects = spec.effects;
  std::map<std::string, std::shared_ptr<const Motion>> motions;
  for (const MovingSubjectSpec& subject : effects.moving_subjects) {
    const auto motion = std::make_shared<Fidgeting>(subject);
    for (const std::string& name : subject.objects) motions[name] = motion;
  }
  for (const ObjectSpec& object : spec.objects) {
    const auto motion = motions.find(object.name);
    add_object(object, motion != motions.end() ? motion->second : nullptr, spec.textures);
  }
  for (const OccluderSpec& occluder : effects.occluders) {
    add_object(occluder_object(occluder), std::make_shared<Passage>(occluder), spec.textures);
  }
  rtcCommitScene(fixed_.get());
  rtcCommitScene(moving_.get());
  for (const auto& body : bodies_) bake(*body, spec.lights);
}

void World::add_object(const ObjectSpec& spec, std::shared_ptr<const Motion> motion,
                       const std::vector<TextureSpec>& textures) {
  auto body = std::make_unique<Body>();
  body->mirror = static_cast<float>(spec.mirror);
  body->glass_ior = static_cast<float>(spec.glass_ior.value_or(0.0));
  body->glass_tint = linear_from_srgb(spec.glass_tint);
  Eigen::Vector2d tile_m = Eigen::Vector2d::Ones();
  const auto texture =
      std::find_if(textures.begin(), textures.end(),
                   [&](const TextureSpec& candidate) { return candidate.name == spec.texture; });
  if (texture != textures.end()) {
    std::shared_ptr<const Texture>& painted = textures_[spec.texture];
    if (!painted) painted = std::make_shared<Texture>(paint_texture(*texture));
    body->texture = painted;
    tile_m = texture->tile_m * spec.texture_scale;
  }
  const bool exact = is_ball(spec) && !motion && (spec.glass_ior || spec.mirror == 1.0);
  bodies_.push_back(std::move(body));
  if (exact) {
    add_exact_sphere(spec);
  } else {
    add_mesh(spec, std::move(motion), tile_m);
  }
}

void World::add_exact_sphere(const ObjectSpec& spec) {
  Body& body = *bodies_.back();
  body.is_exact_sphere = true;
  body.center = spec.world_from_object.translation.cast<float>();
  body.radius = 0.5f * static_cast<float>(spec.size.x());
  const Owned<RTCGeometry> geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER),
                                    rtcReleaseGeometry);
  set_exact_sphere(geometry.get(), &body);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(fixed_.get(), geometry.get(), static_cast<unsigned>(bodies_.size() - 1));
}

void World::add_mesh(const ObjectSpec& spec, std::shared_ptr<const Motion> motion,
                     const Eigen::Vector2d& tile_m) {
  Mesh mesh = make_shape(spec);
  place(mesh, spec.world_from_object);

  Body& body = *bodies_.back();
  const Eigen::Vector2f tiles_per_metre = tile_m.cwiseInverse().cast<float>();
  body.normals = std::move(mesh.normals);
  body.triangles = mesh.triangles;
  const std::vector<float> density = texture_density(mesh);
  for (std::size_t i = 0; i < density.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const Eigen::Vector2f uv = mesh.uv[a].cwiseProduct(tiles_per_metre);
    const Eigen::Vector2f ab = mesh.uv[b].cwiseProduct(tiles_per_metre) - uv;
    const Eigen::Vector2f ac = mesh.uv[c].cwiseProduct(tiles_per_metre) - uv;
    body.surface.push_back(
        {{Float4{0, 0, 0, uv.x()}, Float4{0, 0, 0, ab.x()}, Float4{0, 0, 0, ac.x()}},
         {uv.y(), ab.y(), ac.y()},
         density[i] * tiles_per_metre.maxCoeff()});
  }

  const auto id = static_cast<unsigned>(bodies_.size() - 1);
  const Owned<RTCGeometry> geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE),
                                    rtcReleaseGeometry);
  if (motion) rtcSetGeometryBuildQuality(geometry.get(), RTC_BUILD_QUALITY_REFIT);
  void* positions =
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(Eigen::Vector3f), mesh.positions.size());
  std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<Eigen::Vector3f*>(positions));
  body.facets = facets(mesh);
  auto* corners = static_cast<std::array<std::uint32_t, 3>*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              sizeof(body.facets[0].corners), body.facets.size()));
  for (const Facet& facet : body.facets) *corners++ = facet.corners;
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(motion ? moving_.get() : fixed_.get(), geometry.get(), id);
  if (motion) movers_.push_back({id, mesh.positions, std::move(motion), {}});
  body.positions = std::move(mesh.positions);
}

void World::bake(Body& body, const std::vector<LightSpec>& lights) const {
  std::vector<Float4> light;
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    // What moves receives the shadows of what does not; it casts none that stay behind.
    light.push_back(
        to_float4(baked_light(fixed_.get(), lights, body.positions[i], body.normals[i])));
  }
  for (std::size_t i = 0; i < body.surface.size(); ++i) {
    const auto& [a, b, c] = body.triangles[i];
    body.surface[i].light_and_u[0] += light[a];
    body.surface[i].light_and_u[1] += light[b] - light[a];
    body.surface[i].light_and_u[2] += light[c] - light[a];
  }
  body.positions.clear();
}

void World::intersect8(RayPacket& packet) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(packet.valid, fixed_.get(), &context, &packet.rays);
  if (moves()) rtcIntersect8(packet.valid, moving_.get(), &context, &packet.rays);
}

void World::intersect1(RTCRayHit& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(fixed_.get(), &context, &ray);
  if (moves()) rtcIntersect1(moving_.get(), &context, &ray);
}

bool World::occluded1(RTCRay& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(fixed_.get(), &context, &ray);
  if (moves() && ray.tfar >= 0.0f) rtcOccluded1(moving_.get(), &context, &ray);
  return ray.tfar < 0.0f;
}

Eigen::Vector3f World::normal(const RTCHit& hit, const Eigen::Vector3f& point) const {
  const Body& body = *bodies_[hit.geomID];
  if (body.is_exact_sphere) return (point - body.center).normalized();
  const auto [triangle, u, v] = body.facets[hit.primID].spot(hit.u, hit.v);
  const auto& [a, b, c] = body.triangles[triangle];
  const Eigen::Vector3f at_rest =
      (1.0f - u - v) * body.normals[a] + u * body.normals[b] + v * body.normals[c];
  return (body.world_from_rest * at_rest).normalized();
}

bool World::move_to(double time_s) {
  bool moved = false;
  for (Mover& mover : movers_) {
    const geometry::Pose pose = mover.motion->world_from_rest(time_s);
    if (pose.translation == mover.world_from_rest.translation &&
        pose.rotation.coeffs() == mover.world_from_rest.rotation.coeffs()) {
      continue;
    }
    moved = true;
    mover.world_from_rest = pose;
    const Eigen::Matrix3f rotation = pose.matrix3().cast<float>();
    const Eigen::Vector3f translation = pose.translation.cast<float>();
    bodies_[mover.geometry_id]->world_from_rest = rotation;
    const RTCGeometry geometry = rtcGetGeometry(moving_.get(), mover.geometry_id);
    auto* positions = static_cast<Eigen::Vector3f*>(
        rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));
    for (std::size_t i = 0; i < mover.rest.size(); ++i) {
      positions[i] = rotation * mover.rest[i] + translation;
    }
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry);
  }
  if (moved) rtcCommitScene(moving_.get());
  return moved;
}

}  // namespace lumibox::hal::sim
