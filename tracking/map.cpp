#include "tracking/map.h"

#include <algorithm>

#include "geometry/robust.h"

namespace lumibox::tracking {
namespace {

void append_point(MapView& view, PointId id, const Map::Point& point) {
  view.points.push_back({id, point.position, static_cast<std::uint32_t>(view.sightings.size()),
                         static_cast<std::uint32_t>(point.sightings.size()), point.searched,
                         point.found});
  view.sightings.insert(view.sightings.end(), point.sightings.begin(), point.sightings.end());
}

}  // namespace

const Sighting* Map::Point::sighting_in(KeyframeId keyframe) const {
  const auto place = std::ranges::find(sightings, keyframe, &Sighting::keyframe);
  return place != sightings.end() ? &*place : nullptr;
}

Map::Map(const MapView& view) : next_point_(view.next_point) {
  for (const MapView::Keyframe& k : view.keyframes) {
    keyframes_.push_back({k.world_from_camera,
                          k.readout_twist,
                          k.pyramid,
                          {},
                          k.median_depth,
                          k.scale,
                          k.tied_to,
                          k.tied_from_this});
  }
  for (const MapView::Point& p : view.points) {
    const auto first = view.sightings.begin() + p.first_sighting;
    points_[p.id] = {p.position, {first, first + p.sightings}, p.searched, p.found};
    for (const Sighting& s : points_[p.id].sightings) keyframe(s.keyframe).points.push_back(p.id);
  }
}

KeyframeId Map::add_keyframe(const geometry::FramePose& pose,
                             std::shared_ptr<const Pyramid> pyramid) {
  Keyframe keyframe;
  keyframe.world_from_camera = pose.camera_from_world.inverse();
  keyframe.readout_twist = pose.readout_twist;
  keyframe.pyramid = std::move(pyramid);
  keyframes_.push_back(std::move(keyframe));
  return static_cast<KeyframeId>(keyframes_.size()) - 1;
}

PointId Map::add_point(const Eigen::Vector3d& position) {
  Point point;
  point.position = position;
  points_.emplace(next_point_, std::move(point));
  return next_point_++;
}

void Map::add_sighting(PointId id, const Sighting& sighting) {
  auto& seen = keyframe(sighting.keyframe).points;
  const auto place = std::lower_bound(seen.begin(), seen.end(), id);
  if (place != seen.end() && *place == id) return;
  seen.insert(place, id);
  point(id).sightings.push_back(sighting);
}

void Map::remove_sighting(PointId id, KeyframeId keyframe_id) {
  std::erase_if(point(id).sightings, [&](const Sighting& s) { return s.keyframe == keyframe_id; });
  auto& seen = keyframe(keyframe_id).points;
  const auto place = std::lower_bound(seen.begin(), seen.end(), id);
  if (place != seen.end() && *place == id) seen.erase(place);
}

void Map::remove_point(PointId id) {
  const std::vector<Sighting> sightings = point(id).sightings;
  for (const Sighting& s : sightings) remove_sighting(id, s.keyframe);
  points_.erase(id);
}

void Map::merge_points(PointId kept, PointId other) {
  const Point from = point(other);
  remove_point(other);
  for (const Sighting& s : from.sightings) add_sighting(kept, s);
  point(kept).searched += from.searched;
  point(kept).found += from.found;
}

void Map::cull_keyframe(KeyframeId id, KeyframeId tie) {
  const std::vector<PointId> seen = keyframe(id).points;
  for (const PointId p : seen) {
    remove_sighting(p, id);
    if (point(p).sightings.size() < 2) remove_point(p);
  }
  const geometry::Similarity tie_from_id =
      world_from_keyframe(tie).inverse() * world_from_keyframe(id);
  for (Keyframe& k : keyframes_) {
    if (k.tied_to != id) continue;
    k.tied_to = tie;
    k.tied_from_this = tie_from_id * k.tied_from_this;
  }
  keyframe(id).tied_to = tie;
  keyframe(id).tied_from_this = tie_from_id;
  keyframe(id).pyramid.reset();
}

void Map::move_keyframe(KeyframeId id, const geometry::Similarity& world_from_keyframe) {
  Keyframe& k = keyframe(id);
  const double growth = world_from_keyframe.scale / k.scale;
  k.world_from_camera = world_from_keyframe.rigid;
  k.scale = world_from_keyframe.scale;
  k.readout_twist.head<3>() *= growth;
  k.median_depth *= growth;
}

geometry::Similarity Map::world_from_keyframe(KeyframeId id) const {
  const Keyframe& k = keyframe(id);
  if (k.culled()) return world_from_keyframe(k.tied_to) * k.tied_from_this;
  return {k.scale, k.world_from_camera};
}

void Map::update_depths() {
  for (Keyframe& k : keyframes_) {
    const geometry::Pose camera_from_world = k.world_from_camera.inverse();
    std::vector<double> depths;
    for (const PointId id : k.points) {
      depths.push_back((camera_from_world * point(id).position).z());
    }
    const double median = geometry::median(std::move(depths));
    if (median > 0.0) k.median_depth = median;
  }
}

void Map::scale(double factor) {
  for (Keyframe& k : keyframes_) {
    k.world_from_camera.translation *= factor;
    k.readout_twist.head<3>() *= factor;
    k.tied_from_this.rigid.translation *= factor;
  }
  for (auto& [id, p] : points_) p.position *= factor;
  update_depths();
}

MapView Map::view_without_points() const {
  MapView view;
  view.keyframes.reserve(keyframes_.size());
  for (const Keyframe& k : keyframes_) {
    const geometry::Similarity place =
        world_from_keyframe(static_cast<KeyframeId>(view.keyframes.size()));
    view.keyframes.push_back({place.rigid, place.rigid.inverse(), k.pyramid, k.median_depth,
                              static_cast<int>(k.points.size()), place.scale, k.readout_twist,
                              k.tied_to, k.tied_from_this});
  }
  return view;
}

MapView Map::view(std::uint64_t revision) const {
  MapView view = view_without_points();
  view.revision = revision;
  view.next_point = next_point_;
  view.points.reserve(points_.size());
  for (const auto& [id, p] : points_) append_point(view, id, p);
  return view;
}

MapView Map::view_of(const std::vector<PointId>& points) const {
  MapView view = view_without_points();
  for (const PointId id : points) append_point(view, id, point(id));
  return view;
}

}  // namespace lumibox::tracking
