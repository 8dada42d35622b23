#pragma once

#include <limits>
#include <set>
#include <vector>

#include "tracking/map.h"

namespace lumibox::tracking {

/// Points shared by keyframes that hold each other and belong to one part of the map.
inline constexpr int kConnected = 15;

/// How many points of `id` each keyframe sees, by KeyframeId.
std::vector<int> shared_points(const Map& map, KeyframeId id);

/// Keyframes that share most points with `id`, most first, at most `count`; without `id` itself.
std::vector<KeyframeId> covisible_keyframes(const Map& map, KeyframeId id, int count);

/// A way from keyframe to keyframe, each step between two that share points.
struct Way {
  double length = std::numeric_limits<double>::infinity();  ///< sum of the steps' lengths
  double turn = 0.0;                                        ///< sum of their angles, radians
};

/// Which keyframes see the same points. Ways through this graph are along what was measured, so
/// they tell how much two keyframes can have drifted apart.
class CovisibilityGraph {
 public:
  struct Edge {
    KeyframeId a;  ///< less than b
    KeyframeId b;
    int shared;  ///< points
  };

  /// Edges between keyframes that share at least `min_shared` points.
  CovisibilityGraph(const Map& map, int min_shared);

  const std::vector<Edge>& edges() const { return edges_; }

  /// Keyframes at most `steps` edges away from `start`, and itself.
  std::set<KeyframeId> within(KeyframeId start, int steps) const;

  /// The shortest way from `start` to every keyframe, by KeyframeId; infinitely long where there is
  /// none. Steps longer than `max_step` are not gone, nor does a way go through `without`.
  std::vector<Way> ways_from(KeyframeId start,
                             double max_step = std::numeric_limits<double>::infinity(),
                             KeyframeId without = -1) const;

 private:
  struct Step {
    KeyframeId to;
    Way way;
  };
  std::vector<Edge> edges_;
  std::vector<std::vector<Step>> steps_;  // by KeyframeId
};

}  // namespace lumibox::tracking
