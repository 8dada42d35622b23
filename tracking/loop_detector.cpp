#include "tracking/loop_detector.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/robust.h"
#include "tracking/map_tracking.h"
#include "tracking/relocalisation.h"

namespace lumibox::tracking {
namespace {

constexpr int kNear = 10;              // keyframes around one that are its part of the map
constexpr std::size_t kShortlist = 3;  // keyframes that look alike, and as many that are near
constexpr double kSight = 0.5;  // depths, and radians, between keyframes that show the same place
constexpr std::size_t kMinPairs = 10;  // points known twice, for the scale between the parts
constexpr double kSamePixel = 2.0;     // pixels of the level, of a point known twice
constexpr double kAgreeLength = 0.1;   // of the depth: ties that say the same
constexpr double kAgreeTurn = 0.07;    // radians
constexpr std::uint32_t kSeed = 1;     // of the sampling in P3P

/// The points of a keyframe and of those around it, but for those that `id` sees.
MapView part_around(const Map& map, KeyframeId then, KeyframeId id) {
  std::set<PointId> points;
  std::vector<KeyframeId> part = covisible_keyframes(map, then, kNear);
  part.push_back(then);
  for (const KeyframeId k : part) {
    for (const PointId p : map.keyframe(k).points) {
      if (!map.point(p).sighting_in(id)) points.insert(p);
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
    const Sighting* seen = point.sighting_in(id);
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

std::optional<Loop> LoopDetector::find(const Map& map, const CovisibilityGraph& graph,
                                       KeyframeId id, std::size_t min_ties) {
  const MapView view = map.view(0);
  index_.update(view);
  const std::vector<Way> ways = graph.ways_from(id);
  const geometry::Pose& present = map.keyframe(id).world_from_camera;
  std::vector<Place> places;
  std::vector<PossiblePlace> possible;
  for (const KeyframeId then : candidates(map, graph, id, ways)) {
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

/// Keyframes of other parts of the map in which `id` could be, as far as tracking can have drifted:
/// those that look most like it, and those that would be nearest if it had not. Small images alone
/// tell little where an object fills the picture on all sides.
std::vector<KeyframeId> LoopDetector::candidates(const Map& map, const CovisibilityGraph& graph,
                                                 KeyframeId id,
                                                 const std::vector<Way>& ways) const {
  const std::set<KeyframeId> connected = graph.within(id, 2);
  const Map::Keyframe& here = map.keyframe(id);
  std::vector<std::pair<double, KeyframeId>> near;
  std::set<KeyframeId> possible;
  for (KeyframeId k = 0; k < static_cast<KeyframeId>(ways.size()); ++k) {
    if (map.keyframe(k).culled() || connected.contains(k)) continue;
    const geometry::Pose& there = map.keyframe(k).world_from_camera;
    const double length = (there.translation - here.world_from_camera.translation).norm();
    const double turn = there.rotation.angularDistance(here.world_from_camera.rotation);
    const double depth = here.median_depth;
    const Drift least{std::max(0.0, length - kSight * depth), std::max(0.0, turn - kSight), 1.0};
    if (!is_plausible(least, ways[static_cast<std::size_t>(k)])) continue;
    possible.insert(k);
    near.emplace_back(length / depth + turn, k);
  }
  std::vector<KeyframeId> chosen = index_.most_alike(
      index_.small_image(id), kShortlist, [&](KeyframeId k) { return possible.contains(k); });
  std::sort(near.begin(), near.end());
  for (std::size_t i = 0; i < std::min(kShortlist, near.size()); ++i) {
    if (std::find(chosen.begin(), chosen.end(), near[i].second) == chosen.end())
      chosen.push_back(near[i].second);
  }
  return chosen;
}

std::optional<LoopDetector::Place> LoopDetector::locate(const Map& map, const MapView& view,
                                                        KeyframeId id, KeyframeId then) {
  MapView part = part_around(map, then, id);
  for (const geometry::Pose& guess : guesses(map, view, id, then)) {
    const Localisation* found = localiser_.localise(part, *map.keyframe(id).pyramid,
                                                    {guess, map.keyframe(id).readout_twist});
    if (!found || !is_verified(*found)) continue;
    const auto scale = scale_between(map, id, *found);
    if (!scale) continue;
    Loop::Tie tie = make_tie(id, *scale, part, *found);
    return Place{then, std::move(part), std::move(tie)};
  }
  return std::nullopt;
}

/// Where keyframe `id` may be if it shows what `then` does: by descriptors and P3P, and where
/// `then` is, turned so that their small images agree.
std::vector<geometry::Pose> LoopDetector::guesses(const Map& map, const MapView& view,
                                                  KeyframeId id, KeyframeId then) {
  std::vector<geometry::Pose> poses;
  const DescribedCorners& corners = index_.corners(view, id);
  const auto matched =
      pose_from_matches(camera_, view, corners, index_.match(view, then, corners), kSeed);
  if (matched) poses.push_back(*matched);
  const Eigen::Quaterniond id_from_then =
      estimate_rotation(camera_, index_.small_image(then), index_.small_image(id))
          .current_from_last;
  poses.push_back(geometry::Pose(id_from_then, Eigen::Vector3d::Zero()) *
                  map.keyframe(then).world_from_camera.inverse());
  return poses;
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
