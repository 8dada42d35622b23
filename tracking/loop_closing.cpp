#include "tracking/loop_closing.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "tracking/covisibility.h"
#include "tracking/pose_graph.h"

namespace lumibox::tracking {
namespace {

constexpr double kSamePixel = 0.3;  // of the level; corners farther apart are not one point
constexpr double kSameDepth = 0.1;  // share of the depth
constexpr double kStep = 0.35;      // depths: 20 degrees around what is seen
constexpr double kFar = 1.5;        // depths along the walk, several times as far as it is across

/// Nodes by KeyframeId; culled keyframes are fixed nodes without edges.
PoseGraph make_graph(const Map& map, const CovisibilityGraph& covisibility, const Loop& loop) {
  PoseGraph graph;
  for (const Map::Keyframe& k : map.keyframes()) {
    graph.nodes.push_back({{1.0, k.world_from_camera}, graph.nodes.empty() || k.culled()});
  }
  const auto place = [&](KeyframeId id) {
    return graph.nodes[static_cast<std::size_t>(id)].world_from_node;
  };
  std::vector<bool> held(graph.nodes.size(), false);
  const auto hold = [&](KeyframeId a, KeyframeId b, const geometry::Similarity& world_from_b) {
    graph.edges.push_back({a, b, place(a).inverse() * world_from_b});
    held[static_cast<std::size_t>(a)] = held[static_cast<std::size_t>(b)] = true;
  };
  for (const auto& edge : covisibility.edges()) {
    hold(edge.a, edge.b, place(edge.b));
  }
  for (KeyframeId id = 1; id < static_cast<KeyframeId>(held.size()); ++id) {
    if (held[static_cast<std::size_t>(id)] || map.keyframe(id).culled()) continue;
    const std::vector<KeyframeId> nearest = covisible_keyframes(map, id, 1);
    hold(nearest.empty() ? 0 : nearest.front(), id, place(id));
  }
  for (const Loop::Tie& tie : loop.ties) hold(loop.then, tie.keyframe, tie.world_from_keyframe);
  return graph;
}

void move_map(Map& map, const PoseGraph& graph) {
  std::vector<geometry::Similarity> moved_from_world;  // by KeyframeId
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const geometry::Similarity before{1.0, map.keyframes()[i].world_from_camera};
    moved_from_world.push_back(graph.nodes[i].world_from_node * before.inverse());
  }
  for (const auto& [id, point] : map.points()) {
    const KeyframeId first = point.sightings.front().keyframe;
    map.point(id).position = moved_from_world[static_cast<std::size_t>(first)] * point.position;
  }
  for (KeyframeId id = 0; id < static_cast<KeyframeId>(graph.nodes.size()); ++id) {
    if (map.keyframe(id).culled()) continue;
    geometry::Similarity place = graph.nodes[static_cast<std::size_t>(id)].world_from_node;
    place.scale *= map.keyframe(id).scale;
    map.move_keyframe(id, place);
  }
}

/// A point as one keyframe sees it.
struct Seen {
  PointId point;
  Sighting sighting;
  double depth;
};

std::vector<Seen> seen_by(const Map& map, KeyframeId id) {
  const geometry::Pose camera_from_world = map.keyframe(id).world_from_camera.inverse();
  std::vector<Seen> seen;
  for (const PointId p : map.keyframe(id).points) {
    const Map::Point& point = map.point(p);
    seen.push_back({p, *point.sighting_in(id), (camera_from_world * point.position).z()});
  }
  return seen;
}

bool is_same(const Seen& a, const Seen& b) {
  return a.sighting.level == b.sighting.level &&
         (a.sighting.pixel - b.sighting.pixel).norm() < kSamePixel * (1 << a.sighting.level) &&
         std::abs(a.depth - b.depth) < kSameDepth * a.depth;
}

}  // namespace

int merge_duplicates(Map& map, KeyframeId id) {
  const std::vector<Seen> seen = seen_by(map, id);
  int merged = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (std::size_t j = i + 1; j < seen.size() && map.has_point(seen[i].point); ++j) {
      if (!map.has_point(seen[j].point) || !is_same(seen[i], seen[j])) continue;
      map.merge_points(seen[i].point, seen[j].point);  // ids ascend: the first is the older
      ++merged;
    }
  }
  return merged;
}

bool close_loop(Map& map, const CovisibilityGraph& covisibility, const Loop& loop) {
  PoseGraph graph = make_graph(map, covisibility, loop);
  if (!optimise(graph, map.keyframe(loop.then).median_depth)) return false;
  move_map(map, graph);
  for (const Loop::Tie& tie : loop.ties) {
    for (const auto& [point, sighting] : tie.sightings) {
      if (map.has_point(point)) map.add_sighting(point, sighting);
    }
    merge_duplicates(map, tie.keyframe);
  }
  map.update_depths();
  return true;
}

bool has_met_itself(const Map& map, const CovisibilityGraph& graph, KeyframeId id) {
  const std::vector<KeyframeId> nearest = covisible_keyframes(map, id, 1);
  if (nearest.empty()) return false;
  const double depth = map.keyframe(id).median_depth;
  const std::vector<Way> ways = graph.ways_from(nearest.front(), kStep * depth, id);
  const Eigen::Vector3d here = map.keyframe(id).world_from_camera.translation;
  for (const auto& edge : graph.edges()) {
    if (edge.a != id && edge.b != id) continue;
    const KeyframeId other = edge.a == id ? edge.b : edge.a;
    const double length = ways[static_cast<std::size_t>(other)].length;
    const double direct = (map.keyframe(other).world_from_camera.translation - here).norm();
    if (direct < kStep * depth && std::isfinite(length) && length > kFar * depth) return true;
  }
  return false;
}

}  // namespace lumibox::tracking
