#include "tracking/keyframe_culling.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "tracking/covisibility.h"
#include "tracking/keyframe_chooser.h"

namespace lumibox::tracking {
namespace {

constexpr int kLookedAt = 20;        // keyframes around the newest
constexpr KeyframeId kNewest = 3;    // not yet seen by others as they will be
constexpr double kNextTo = 0.5;      // of the distance at which a new one is asked for
constexpr double kSameView = 0.25;   // radians
constexpr std::size_t kOthers = 3;   // that see a point as well
constexpr double kKnownShare = 0.9;  // of its points

bool is_known_without(const Map& map, PointId id, KeyframeId keyframe) {
  const Map::Point& point = map.point(id);
  const int level = point.sighting_in(keyframe)->level;
  std::size_t others = 0;
  for (const Sighting& s : point.sightings) {
    if (s.keyframe != keyframe && s.level <= level) ++others;
  }
  return others >= kOthers;
}

bool is_redundant(const Map& map, KeyframeId id) {
  const std::vector<PointId>& points = map.keyframe(id).points;
  const auto known = std::ranges::count_if(
      points, [&](PointId point) { return is_known_without(map, point, id); });
  return static_cast<double>(known) >= kKnownShare * static_cast<double>(points.size());
}

/// The older keyframe that stands in for one, if there is any: templates that are old have not
/// drifted (docs/tracking.md).
std::optional<KeyframeId> stand_in(const config::Tracking& options, const Map& map, KeyframeId id) {
  const Map::Keyframe& here = map.keyframe(id);
  double nearest = kNextTo * here.median_depth * wanted_baseline(options);
  std::optional<KeyframeId> chosen;
  for (const KeyframeId k : covisible_keyframes(map, id, kLookedAt)) {
    if (k > id) continue;
    const geometry::Pose here_from_there =
        here.world_from_camera.inverse() * map.keyframe(k).world_from_camera;
    const double turn = here_from_there.rotation.angularDistance(Eigen::Quaterniond::Identity());
    if (here_from_there.translation.norm() >= nearest || turn > kSameView) continue;
    nearest = here_from_there.translation.norm();
    chosen = k;
  }
  return chosen;
}

}  // namespace

int cull_keyframes(const config::Tracking& options, Map& map, KeyframeId newest) {
  int culled = 0;
  std::vector<KeyframeId> candidates = covisible_keyframes(map, newest, kLookedAt);
  std::ranges::sort(candidates);  // what one stands in for is near it, not near what is near it
  for (const KeyframeId id : candidates) {
    if (id > newest - kNewest || !is_redundant(map, id)) continue;
    const auto other = stand_in(options, map, id);
    if (!other) continue;
    map.cull_keyframe(id, *other);
    ++culled;
  }
  return culled;
}

}  // namespace lumibox::tracking
