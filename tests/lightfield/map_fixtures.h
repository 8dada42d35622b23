#pragma once

#include <memory>
#include <random>
#include <string>

#include "geometry/rotation.h"
#include "lightfield/fixtures.h"
#include "tracking/map.h"

namespace lumibox::lightfield {

/// A map as the tracker makes them, of small_camera(): `keyframes` keyframes with pictures of noise
/// and points that two or three of them see; numbers with all their digits. Ids have gaps; of four
/// or more keyframes one is culled and one has been scaled.
inline tracking::MapView make_map(int keyframes, unsigned seed = 1) {
  std::mt19937 random(seed);
  const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  tracking::Map map;
  for (int i = 0; i < keyframes; ++i) {
    hal::Image image(16, 12, 1);
    for (std::size_t p = 0; p < image.size_bytes(); ++p) {
      image.data()[p] = static_cast<std::uint8_t>(random() % 256U);
    }
    geometry::FramePose pose(
        geometry::Pose(geometry::exp_so3({uniform(), 3.0 * uniform(), -uniform()}),
                       {uniform(), uniform(), i / 3.0}));
    pose.readout_twist << 1e-3 * uniform(), 0.0, -1e-17, uniform(), 1.0 / 3.0, -uniform();
    map.add_keyframe(pose, std::make_shared<const tracking::Pyramid>(std::move(image), 2));
  }
  for (int i = 0; i < 12 * keyframes; ++i) {
    const tracking::PointId id = map.add_point({uniform() - 0.5, uniform() - 0.5, 1e3 * uniform()});
    map.point(id).searched = i;
    map.point(id).found = i;
    for (int k = 0; k < std::min(keyframes, 2 + i % 2); ++k) {
      map.add_sighting(id, {k, {15.0 * uniform(), 11.0 * uniform()}, i % 2});
    }
  }
  map.remove_point(4);
  map.remove_point(12 * keyframes - 1);  // the last: its id must not come back
  map.update_depths();
  if (keyframes > 3) {
    map.move_keyframe(1, {1.25, map.keyframe(1).world_from_camera});
    map.cull_keyframe(2, 1);
  }
  return map.view(1);
}

inline bool same(const geometry::Pose& a, const geometry::Pose& b) {
  return geometry::canonical(a.rotation).coeffs() == geometry::canonical(b.rotation).coeffs() &&
         a.translation == b.translation;
}

/// What differs, to the bit; empty if nothing does. A rotation may change its quaternion's sign.
inline std::string difference(const tracking::MapView& a, const tracking::MapView& b) {
  if (a.next_point != b.next_point) return "next point";
  if (a.keyframes.size() != b.keyframes.size()) return "keyframes";
  for (std::size_t i = 0; i < a.keyframes.size(); ++i) {
    const auto& k = a.keyframes[i];
    const auto& l = b.keyframes[i];
    if (!same(k.world_from_camera, l.world_from_camera) ||
        !same(k.camera_from_world, l.camera_from_world)) {
      return "pose";
    }
    if (k.scale != l.scale || k.tied_to != l.tied_to) return "tie";
    if (k.tied_from_this.scale != l.tied_from_this.scale ||
        !same(k.tied_from_this.rigid, l.tied_from_this.rigid)) {
      return "place in tie";
    }
    if (k.culled() != l.culled()) return "culled";
    if (k.culled()) continue;
    if (k.readout_twist != l.readout_twist || k.median_depth != l.median_depth) return "keyframe";
    if (k.points != l.points) return "number of points seen";
    if (k.pyramid->levels() != l.pyramid->levels()) return "levels";
    for (int level = 0; level < k.pyramid->levels(); ++level) {
      if (k.pyramid->level(level) != l.pyramid->level(level)) return "picture";
    }
  }
  if (a.points.size() != b.points.size() || a.sightings.size() != b.sightings.size())
    return "points";
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    const auto& p = a.points[i];
    const auto& q = b.points[i];
    if (p.id != q.id || p.position != q.position || p.first_sighting != q.first_sighting ||
        p.sightings != q.sightings || p.searched != q.searched || p.found != q.found) {
      return "point";
    }
  }
  for (std::size_t i = 0; i < a.sightings.size(); ++i) {
    const auto& s = a.sightings[i];
    const auto& t = b.sightings[i];
    if (s.keyframe != t.keyframe || s.pixel != t.pixel || s.level != t.level) return "sighting";
  }
  return "";
}

}  // namespace lumibox::lightfield
