#include "tracking/loop_detector.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/robust.h"
#include "tracking/map_tracking.h"
#include "tracking/relocalisation.h"

namespace lumibox::tracking {
namespace {

constexpr int kConnected = 15;         // points shared by keyframes that belong together
constexpr int kNear = 10;              // keyframes around one that are its part of the map
constexpr std::size_t kShortlist = 4;  // keyframes matched in full
constexpr std::size_t kMinPairs = 10;  // points known twice, for the scale between the parts
constexpr double kSamePixel = 2.0;     // pixels of the level, of a point known twice
constexpr double kAgreeLength = 0.1;   // of the depth: ties that say the same
constexpr double kAgreeTurn = 0.07;    // radians
constexpr std::uint32_t kSeed = 1;     // of the sampling in P3P

/// Keyframes that share many points with `id`, and those that do with them.
std::set<KeyframeId> connected_to(const Map& map, KeyframeId id) {
  std::set<KeyframeId> connected{id};
  std::vector<KeyframeId> front{id};
  for (int hop = 0; hop < 2; ++hop) {
    std::vector<KeyframeId> next;
    for (const KeyframeId from : front) {
      std::vector<int> shared(map.keyframes().size(), 0);
      for (const PointId p : map.keyframe(from).points) {
        for (const Sighting& s : map.point(p).sightings)
          ++shared[static_cast<std::size_t>(s.keyframe)];
      }
      for (KeyframeId k = 0; k < static_cast<KeyframeId>(shared.size()); ++k) {
        if (shared[static_cast<std::size_t>(k)] < kConnected) continue;
        if (connected.insert(k).second) next.push_back(k);
      }
    }
    front = std::move(next);
  }
  return connected;
}

const Sighting* sighting_in(const Map::Point& point, KeyframeId keyframe) {
  for (const Sighting& s : point.sightings) {
    if (s.keyframe == keyframe) return &s;
  }
  return nullptr;
}

/// The points of a keyframe and of those around it, but for those that `id` sees.
MapView part_around(const Map& map, KeyframeId then, KeyframeId id) {
  std::set<PointId> points;
  std::vector<KeyframeId> part = covisible_keyframes(map, then, kNear);
  part.push_back(then);
  for (const KeyframeId k : part) {
    for (const PointId p : map.keyframe(k).points) {
      if (!sighting_in(map.point(p), id)) points.insert(p);
    }
  }
  return map.view_of({points.begin(), points.end()});
}

/// By how much the older part is larger: from the depths of points that both parts have, told by
/// where `id` sees them. None if there are too few.
std::optional<double> scale_between(const Map& map, KeyframeId id, const Localisation& found) {
  const geometry::Pose camera_from_world = map.keyframe(id).world_from_camera.inverse();
  std::vector<double> ratios;
  for (const PointId p : map.keyframe(id).points) {
    const Map::Point& point = map.point(p);
    const Sighting* seen = sighting_in(point, id);
    for (const Measurement& m : found.measurements) {
      if (!m.inlier || (m.pixel - seen->pixel).norm() > kSamePixel * (1 << seen->level)) continue;
      ratios.push_back((found.pose.camera_from_world * m.position).z() /
                       (camera_from_world * point.position).z());
    }
  }
  if (ratios.size() < kMinPairs) return std::nullopt;
  const double ratio = geometry::median(std::move(ratios));
  return ratio > 0.0 ? std::optional(ratio) : std::nullopt;
}

Loop::Tie make_tie(KeyframeId id, double scale, const MapView& part, const Localisation& found) {
  Loop::Tie tie{id, {scale, found.pose.camera_from_world.inverse()}, {}};
  for (const Measurement& m : found.measurements) {
    if (m.inlier)
      tie.sightings.emplace_back(part.points[m.point].id, Sighting{id, m.pixel, m.level});
  }
  return tie;
}

}  // namespace

/// A possible place of a keyframe in an older part of the map.
struct LoopDetector::Place {
  KeyframeId then;
  MapView part;
  Loop::Tie tie;
};

bool is_plausible(const Drift& drift, const Way& way) {
  constexpr double kMaxShare = 0.25;  // of the length, and of the turning, on the way
  constexpr double kMinTurn = 0.1;    // radians, on a way without turns
  constexpr double kMaxScale = 2.0;   // either way
  return drift.length < kMaxShare * way.length && drift.turn < kMinTurn + kMaxShare * way.turn &&
         drift.scale < kMaxScale && drift.scale > 1.0 / kMaxScale;
}

std::optional<Loop> LoopDetector::find(const Map& map, KeyframeId id, std::size_t min_ties) {
  const MapView view = map.view(0);
  index_.update(view);
  const std::vector<KeyframeId> alike = candidates(map, id);
  if (alike.empty()) return std::nullopt;
  const std::vector<Way> ways = CovisibilityGraph(map, kConnected).ways_from(id);
  const geometry::Pose& present = map.keyframe(id).world_from_camera;
  std::vector<Place> places;
  std::vector<PossiblePlace> possible;
  for (const KeyframeId then : alike) {
    auto place = locate(map, view, id, then);
    if (!place) continue;
    const geometry::Similarity& there = place->tie.world_from_keyframe;
    const Drift drift{(there.rigid.translation - present.translation).norm(),
                      there.rigid.rotation.angularDistance(present.rotation), there.scale};
    if (!is_plausible(drift, ways[static_cast<std::size_t>(then)])) continue;
    possible.push_back({there.rigid.inverse(), static_cast<int>(place->tie.sightings.size())});
    places.push_back(std::move(*place));
  }
  const auto chosen = choose_place(possible, map.keyframe(id).median_depth);
  if (!chosen) return std::nullopt;
  Loop loop{places[*chosen].then, ties(map, id, places[*chosen])};
  if (loop.ties.size() < min_ties) return std::nullopt;
  return loop;
}

/// Keyframes of other parts of the map that look like `id` at least as much as those around it do.
std::vector<KeyframeId> LoopDetector::candidates(const Map& map, KeyframeId id) const {
  const std::set<KeyframeId> connected = connected_to(map, id);
  const SmallImage& picture = index_.small_image(id);
  double worst = 0.0;
  for (const KeyframeId k : covisible_keyframes(map, id, kNear)) {
    worst = std::max(worst, index_.difference(picture, k));
  }
  return index_.most_alike(picture, kShortlist, [&](KeyframeId k) {
    return !connected.contains(k) && index_.difference(picture, k) <= worst;
  });
}

std::optional<LoopDetector::Place> LoopDetector::locate(const Map& map, const MapView& view,
                                                        KeyframeId id, KeyframeId then) {
  const DescribedCorners& corners = index_.corners(view, id);
  const auto pose =
      pose_from_matches(camera_, view, corners, index_.match(view, then, corners), kSeed);
  if (!pose) return std::nullopt;
  MapView part = part_around(map, then, id);
  const Localisation* found =
      localiser_.localise(part, *map.keyframe(id).pyramid, {*pose, map.keyframe(id).readout_twist});
  if (!found || !is_verified(*found)) return std::nullopt;
  const auto scale = scale_between(map, id, *found);
  if (!scale) return std::nullopt;
  Loop::Tie tie = make_tie(id, *scale, part, *found);
  return Place{then, std::move(part), std::move(tie)};
}

/// The tie of `id` and those of the keyframes around it that say the same.
std::vector<Loop::Tie> LoopDetector::ties(const Map& map, KeyframeId id, const Place& place) {
  std::vector<Loop::Tie> agreed{place.tie};
  const geometry::Similarity corrected =
      place.tie.world_from_keyframe *
      geometry::Similarity{1.0, map.keyframe(id).world_from_camera}.inverse();
  for (const KeyframeId k : covisible_keyframes(map, id, kNear)) {
    const Map::Keyframe& keyframe = map.keyframe(k);
    const geometry::Pose expected = corrected * keyframe.world_from_camera;
    geometry::Vector6d twist = keyframe.readout_twist;
    twist.head<3>() *= corrected.scale;
    const Localisation* found =
        localiser_.localise(place.part, *keyframe.pyramid, {expected.inverse(), twist});
    if (!found || !is_verified(*found)) continue;
    const geometry::Pose off = found->pose.camera_from_world * expected;
    if (off.translation.norm() > kAgreeLength * corrected.scale * keyframe.median_depth ||
        off.rotation.angularDistance(Eigen::Quaterniond::Identity()) > kAgreeTurn) {
      continue;
    }
    agreed.push_back(make_tie(k, corrected.scale, place.part, *found));
  }
  return agreed;
}

}  // namespace lumibox::tracking
