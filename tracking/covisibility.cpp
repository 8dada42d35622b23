#include "tracking/covisibility.h"

#include <algorithm>
#include <queue>
#include <utility>

namespace lumibox::tracking {

CovisibilityGraph::CovisibilityGraph(const Map& map, int min_shared)
    : steps_(map.keyframes().size()) {
  const auto count = static_cast<KeyframeId>(steps_.size());
  for (KeyframeId a = 0; a < count; ++a) {
    const std::vector<int> shared = shared_points(map, a);
    for (KeyframeId b = a + 1; b < count; ++b) {
      const int points = shared[static_cast<std::size_t>(b)];
      if (points < std::max(min_shared, 1)) continue;
      edges_.push_back({a, b, points});
      const geometry::Pose& from = map.keyframe(a).world_from_camera;
      const geometry::Pose& to = map.keyframe(b).world_from_camera;
      const Way way{(from.translation - to.translation).norm(),
                    from.rotation.angularDistance(to.rotation)};
      steps_[static_cast<std::size_t>(a)].push_back({b, way});
      steps_[static_cast<std::size_t>(b)].push_back({a, way});
    }
  }
}

std::set<KeyframeId> CovisibilityGraph::within(KeyframeId start, int steps) const {
  std::set<KeyframeId> reached{start};
  std::vector<KeyframeId> front{start};
  for (int i = 0; i < steps; ++i) {
    std::vector<KeyframeId> next;
    for (const KeyframeId from : front) {
      for (const Step& step : steps_[static_cast<std::size_t>(from)]) {
        if (reached.insert(step.to).second) next.push_back(step.to);
      }
    }
    front = std::move(next);
  }
  return reached;
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

std::vector<int> shared_points(const Map& map, KeyframeId id) {
  std::vector<int> shared(map.keyframes().size(), 0);
  for (const PointId point : map.keyframe(id).points) {
    for (const Sighting& s : map.point(point).sightings)
      ++shared[static_cast<std::size_t>(s.keyframe)];
  }
  return shared;
}

std::vector<KeyframeId> covisible_keyframes(const Map& map, KeyframeId id, int count) {
  const std::vector<int> shared = shared_points(map, id);
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
