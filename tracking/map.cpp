#include "tracking/map.h"

#include <algorithm>

#include "geometry/robust.h"

namespace lumibox::tracking {
namespace {

void append_point(MapView& view, PointId id, const Map::Point& point) {
  view.points.push_back({id, point.position, static_cast<std::uint32_t>(view.sightings.size()),
                         static_cast<std::uint32_t>(point.sightings.size())});
  view.sightings.insert(view.sightings.end(), point.sightings.begin(), point.sightings.end());
}

}  // namespace

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
  }
  for (auto& [id, p] : points_) p.position *= factor;
  update_depths();
}

MapView Map::view_without_points() const {
  MapView view;
  view.keyframes.reserve(keyframes_.size());
  for (const Keyframe& k : keyframes_) {
    view.keyframes.push_back({k.world_from_camera, k.world_from_camera.inverse(), k.pyramid,
                              k.median_depth, static_cast<int>(k.points.size())});
  }
  return view;
}

MapView Map::view(std::uint64_t revision) const {
  MapView view = view_without_points();
  view.revision = revision;
  view.points.reserve(points_.size());
  for (const auto& [id, p] : points_) append_point(view, id, p);
  return view;
}

MapView Map::view_of(const std::vector<PointId>& points) const {
  MapView view = view_without_points();
  for (const PointId id : points) append_point(view, id, point(id));
  return view;
}

std::vector<KeyframeId> covisible_keyframes(const Map& map, KeyframeId id, int count) {
  std::vector<int> shared(map.keyframes().size(), 0);
  for (const PointId point : map.keyframe(id).points) {
    for (const Sighting& s : map.point(point).sightings)
      ++shared[static_cast<std::size_t>(s.keyframe)];
  }
  std::vector<KeyframeId> order;
  for (KeyframeId k = 0; k < static_cast<KeyframeId>(shared.size()); ++k) {
    if (k != id && shared[static_cast<std::size_t>(k)] > 0) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(), [&](KeyframeId a, KeyframeId b) {
    return shared[static_cast<std::size_t>(a)] > shared[static_cast<std::size_t>(b)];
  });
  if (order.size() > static_cast<std::size_t>(count)) order.resize(static_cast<std::size_t>(count));
  return order;
}

}  // namespace lumibox::tracking
