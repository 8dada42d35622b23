#pragma once

#include <vector>

#include "geometry/pose.h"

namespace lumibox::tracking {

/// Places whose relations are known, not quite in agreement.
struct PoseGraph {
  struct Node {
    geometry::Similarity world_from_node;
    bool fixed = false;
  };
  struct Edge {
    int a = 0;  ///< index into nodes
    int b = 0;
    geometry::Similarity a_from_b;  ///< as measured
  };
  std::vector<Node> nodes;
  std::vector<Edge> edges;
};

/// Moves the nodes that are not fixed so that the sum of the squared logarithms of what is left of
/// each edge, log(b_from_a * inverse(world_from_a) * world_from_b), is least: drift of place, turn
/// and scale is spread over the graph (Strasdat, Montiel and Davison, "Scale drift-aware large
/// scale monocular SLAM", RSS 2010). Lengths count in units of `unit`. False, with nothing changed,
/// if the graph does not hold all nodes together or no step lowers the sum.
bool optimise(PoseGraph& graph, double unit);

}  // namespace lumibox::tracking
