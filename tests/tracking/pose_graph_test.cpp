#include "tracking/pose_graph.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lumibox::tracking {
namespace {

geometry::Similarity on_ring(int i, int count, double radius) {
  const double angle = 2.0 * std::numbers::pi * i / count;
  return {1.0,
          {geometry::exp_so3({0.0, angle, 0.0}),
           radius * Eigen::Vector3d(std::cos(angle), 0.0, std::sin(angle))}};
}

/// A ring of nodes whose steps are right but whose places have drifted, closed by one edge.
PoseGraph drifted_ring(int count, double radius) {
  geometry::Vector7d drift;
  drift << 0.004 * radius, 0.0, 0.003 * radius, 0.002, 0.005, -0.001, 0.006;
  PoseGraph graph;
  graph.nodes.push_back({on_ring(0, count, radius), true});
  for (int i = 0; i + 1 < count; ++i) {
    const geometry::Similarity step =
        on_ring(i, count, radius).inverse() * on_ring(i + 1, count, radius);
    graph.nodes.push_back(
        {graph.nodes.back().world_from_node * step * geometry::exp_sim3(drift), false});
    graph.edges.push_back({i, i + 1, step});
  }
  graph.edges.push_back(
      {count - 1, 0, on_ring(count - 1, count, radius).inverse() * on_ring(0, count, radius)});
  return graph;
}

double distance(const geometry::Similarity& a, const geometry::Similarity& b) {
  return geometry::log_sim3(a.inverse() * b).norm();
}

// All edges can be met at once: the sum goes to zero, up to the rule that stops.
TEST(PoseGraph, RecoversARingWhoseEdgesAgree) {
  PoseGraph graph = drifted_ring(40, 1.0);
  ASSERT_GT(distance(graph.nodes.back().world_from_node, on_ring(39, 40, 1.0)), 0.2);
  ASSERT_TRUE(optimise(graph, 1.0));
  for (int i = 0; i < 40; ++i) {
    EXPECT_LT(
        distance(graph.nodes[static_cast<std::size_t>(i)].world_from_node, on_ring(i, 40, 1.0)),
        1e-6);
  }
}

// Each edge says that it grows by the same factor; only the closing one denies it.
TEST(PoseGraph, SpreadsWhatDoesNotFitOverAllEdges) {
  PoseGraph graph = drifted_ring(20, 1.0);
  for (std::size_t i = 0; i + 1 < graph.edges.size(); ++i) graph.edges[i].a_from_b.scale = 1.01;
  for (int i = 0; i < 20; ++i) {
    graph.nodes[static_cast<std::size_t>(i)].world_from_node.scale = std::pow(1.01, i);
  }
  ASSERT_TRUE(optimise(graph, 1.0));
  for (const auto& edge : graph.edges) {
    const auto& a = graph.nodes[static_cast<std::size_t>(edge.a)].world_from_node;
    const auto& b = graph.nodes[static_cast<std::size_t>(edge.b)].world_from_node;
    EXPECT_NEAR((edge.a_from_b.inverse() * a.inverse() * b).scale, std::pow(1.01, -0.95), 2e-3);
  }
}

TEST(PoseGraph, TheWorldsScaleDoesNotMatter) {
  PoseGraph small = drifted_ring(30, 1.0);
  PoseGraph large = drifted_ring(30, 1e6);
  ASSERT_TRUE(optimise(small, 1.0));
  ASSERT_TRUE(optimise(large, 1e6));
  for (std::size_t i = 0; i < small.nodes.size(); ++i) {
    EXPECT_LT((1e6 * small.nodes[i].world_from_node.rigid.translation -
               large.nodes[i].world_from_node.rigid.translation)
                  .norm(),
              1.0);
  }
}

TEST(PoseGraph, ANodeThatNothingHoldsChangesNothing) {
  PoseGraph graph = drifted_ring(10, 1.0);
  graph.nodes.push_back({on_ring(3, 10, 1.0), false});
  const PoseGraph before = graph;
  EXPECT_FALSE(optimise(graph, 1.0));
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    EXPECT_EQ(graph.nodes[i].world_from_node.rigid.translation,
              before.nodes[i].world_from_node.rigid.translation);
  }
}

}  // namespace
}  // namespace lumibox::tracking
