#include "hal/sim/exact_sphere.h"

#include <cmath>
#include <optional>

#include "hal/sim/world.h"

namespace lumibox::hal::sim {
namespace {

/// Distance along the ray, in lengths of `direction`, of the first crossing in (near, far).
std::optional<float> first_crossing(const Body& body, const Eigen::Vector3f& origin,
                                    const Eigen::Vector3f& direction, float near, float far) {
  // In double: at grazing incidence the discriminant is a difference of nearly equal numbers.
  const Eigen::Vector3d d = direction.cast<double>();
  const Eigen::Vector3d from_center = (origin - body.center).cast<double>();
  const double radius = static_cast<double>(body.radius);
  const double a = d.squaredNorm();
  const double half_b = from_center.dot(d);
  const double c = from_center.squaredNorm() - radius * radius;
  const double discriminant = half_b * half_b - a * c;
  if (!(discriminant >= 0.0 && a > 0.0)) return std::nullopt;
  const double root = std::sqrt(discriminant);
  for (const double t : {(-half_b - root) / a, (-half_b + root) / a}) {
    const float crossing = static_cast<float>(t);
    if (crossing > near && crossing < far) return crossing;
  }
  return std::nullopt;
}

Eigen::Vector3f ray_origin(RTCRayN* rays, unsigned n, unsigned i) {
  return {RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)};
}

Eigen::Vector3f ray_direction(RTCRayN* rays, unsigned n, unsigned i) {
  return {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)};
}

void bounds(const RTCBoundsFunctionArguments* args) {
  const Body& body = *static_cast<const Body*>(args->geometryUserPtr);
  RTCBounds& box = *args->bounds_o;
  box.lower_x = body.center.x() - body.radius;
  box.lower_y = body.center.y() - body.radius;
  box.lower_z = body.center.z() - body.radius;
  box.upper_x = body.center.x() + body.radius;
  box.upper_y = body.center.y() + body.radius;
  box.upper_z = body.center.z() + body.radius;
}

void intersect(const RTCIntersectFunctionNArguments* args) {
  const Body& body = *static_cast<const Body*>(args->geometryUserPtr);
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const Eigen::Vector3f origin = ray_origin(rays, args->N, i);
    const Eigen::Vector3f direction = ray_direction(rays, args->N, i);
    const std::optional<float> t = first_crossing(
        body, origin, direction, RTCRayN_tnear(rays, args->N, i), RTCRayN_tfar(rays, args->N, i));
    if (!t) continue;
    const Eigen::Vector3f normal = origin + *t * direction - body.center;
    RTCRayN_tfar(rays, args->N, i) = *t;
    RTCHitN_Ng_x(hits, args->N, i) = normal.x();
    RTCHitN_Ng_y(hits, args->N, i) = normal.y();
    RTCHitN_Ng_z(hits, args->N, i) = normal.z();
    RTCHitN_u(hits, args->N, i) = 0.0f;
    RTCHitN_v(hits, args->N, i) = 0.0f;
    RTCHitN_primID(hits, args->N, i) = args->primID;
    RTCHitN_geomID(hits, args->N, i) = args->geomID;
    RTCHitN_instID(hits, args->N, i, 0) = args->context->instID[0];
  }
}

void occluded(const RTCOccludedFunctionNArguments* args) {
  const Body& body = *static_cast<const Body*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const bool hit =
        first_crossing(body, ray_origin(args->ray, args->N, i),
                       ray_direction(args->ray, args->N, i), RTCRayN_tnear(args->ray, args->N, i),
                       RTCRayN_tfar(args->ray, args->N, i))
            .has_value();
    if (hit) RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
  }
}

}  // namespace

void set_exact_sphere(RTCGeometry geometry, Body* body) {
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, body);
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryOccludedFunction(geometry, occluded);
}

}  // namespace lumibox::hal::sim
