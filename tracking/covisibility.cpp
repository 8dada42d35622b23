#include "tracking/covisibility.h"

#include <algorithm>
#include <map>
#include <queue>
#include <utility>

namespace lumibox::tracking {

CovisibilityGraph::CovisibilityGraph(const Map& map, int min_shared)
    : steps_(map.keyframes().size()) {
  std::map<std::pair<KeyframeId, KeyframeId>, int> shared;
  for (const auto& [id, point] : map.points()) {
    for (std::size_t i = 0; i < point.sightings.size(); ++i) {
      for (std::size_t j = i + 1; j < point.sightings.size(); ++j) {
        ++shared[std::minmax(point.sightings[i].keyframe, point.sightings[j].keyframe)];
      }
    }
  }
  for (const auto& [pair, count] : shared) {
    if (count < min_shared) continue;
    const auto [a, b] = pair;
    edges_.push_back({a, b, count});
    const geometry::Pose& from = map.keyframe(a).world_from_camera;
    const geometry::Pose& to = map.keyframe(b).world_from_camera;
    const Way way{(from.translation - to.translation).norm(),
                  from.rotation.angularDistance(to.rotation)};
    steps_[static_cast<std::size_t>(a)].push_back({b, way});
    steps_[static_cast<std::size_t>(b)].push_back({a, way});
  }
}

std::vector<Way> CovisibilityGraph::ways_from(KeyframeId start, double max_step,
                                              KeyframeId without) const {
  std::vector<Way> ways(steps_.size());
  ways[static_cast<std::size_t>(start)] = {0.0, 0.0};
  using Entry = std::pair<double, KeyframeId>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.emplace(0.0, start);
  while (!open.empty()) {  // Dijkstra, 1959
    const auto [length, at] = open.top();
    open.pop();
    const Way here = ways[static_cast<std::size_t>(at)];
    if (length > here.length || at == without) continue;
    for (const Step& step : steps_[static_cast<std::size_t>(at)]) {
      if (step.way.length > max_step) continue;
      Way& there = ways[static_cast<std::size_t>(step.to)];
      if (here.length + step.way.length < there.length) {
        there = {here.length + step.way.length, here.turn + step.way.turn};
        open.emplace(there.length, step.to);
      }
    }
  }
  return ways;
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
