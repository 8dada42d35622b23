#include "tracking/pose_graph.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <optional>

namespace lumibox::tracking {
namespace {

using geometry::Similarity;
using geometry::Vector7d;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

constexpr int kMaxIterations = 30;
constexpr double kConverged = 1e-8;  // relative decrease of the cost

/// Adjoint of Sim(3): exp(adjoint * twist) = s exp(twist) inverse(s).
Matrix7d adjoint(const Similarity& s) {
  const Eigen::Matrix3d rotation = s.rigid.matrix3();
  Matrix7d result = Matrix7d::Zero();
  result.topLeftCorner<3, 3>() = s.scale * rotation;
  result.block<3, 3>(0, 3) = geometry::skew(s.rigid.translation) * rotation;
  result.block<3, 1>(0, 6) = -s.rigid.translation;
  result.block<3, 3>(3, 3) = rotation;
  result(6, 6) = 1.0;
  return result;
}

Similarity scaled(Similarity s, double factor) {
  s.rigid.translation *= factor;
  return s;
}

Vector7d residual_of(const PoseGraph& graph, const PoseGraph::Edge& edge) {
  const Similarity& a = graph.nodes[static_cast<std::size_t>(edge.a)].world_from_node;
  const Similarity& b = graph.nodes[static_cast<std::size_t>(edge.b)].world_from_node;
  return geometry::log_sim3(edge.a_from_b.inverse() * a.inverse() * b);
}

double cost_of(const PoseGraph& graph) {
  double sum = 0.0;
  for (const auto& edge : graph.edges) sum += residual_of(graph, edge).squaredNorm();
  return sum;
}

/// First column of each node's seven in the normal equations; -1 of a fixed one.
std::vector<int> columns_of(const PoseGraph& graph, int& count) {
  std::vector<int> columns;
  count = 0;
  for (const auto& node : graph.nodes) {
    columns.push_back(node.fixed ? -1 : count);
    if (!node.fixed) count += 7;
  }
  return columns;
}

struct Equations {
  Eigen::SparseMatrix<double> hessian;  // lower triangle
  Eigen::VectorXd gradient;
};

/// With nodes moved from the right, exp(step) behind world_from_node. The derivative of the
/// logarithm is taken as that at zero: what is left of an edge is small.
Equations linearise(const PoseGraph& graph, const std::vector<int>& columns, int count,
                    double damping) {
  Equations equations{Eigen::SparseMatrix<double>(count, count), Eigen::VectorXd::Zero(count)};
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int row, int column, const Matrix7d& block) {
    for (int i = 0; i < 7; ++i) {
      for (int j = 0; j < 7; ++j) {
        if (row + i >= column + j) entries.emplace_back(row + i, column + j, block(i, j));
      }
    }
  };
  for (const auto& edge : graph.edges) {
    const Vector7d residual = residual_of(graph, edge);
    const Similarity& a = graph.nodes[static_cast<std::size_t>(edge.a)].world_from_node;
    const Similarity& b = graph.nodes[static_cast<std::size_t>(edge.b)].world_from_node;
    const Matrix7d by_a = -adjoint(b.inverse() * a);  // by_b is the identity
    const int at_a = columns[static_cast<std::size_t>(edge.a)];
    const int at_b = columns[static_cast<std::size_t>(edge.b)];
    if (at_a >= 0) {
      add(at_a, at_a, by_a.transpose() * by_a);
      equations.gradient.segment<7>(at_a) += by_a.transpose() * residual;
    }
    if (at_b >= 0) {
      add(at_b, at_b, Matrix7d::Identity());
      equations.gradient.segment<7>(at_b) += residual;
    }
    if (at_a >= 0 && at_b > at_a) add(at_b, at_a, by_a);
    if (at_b >= 0 && at_a > at_b) add(at_a, at_b, by_a.transpose());
  }
  equations.hessian.setFromTriplets(entries.begin(), entries.end());
  for (int i = 0; i < count; ++i) equations.hessian.coeffRef(i, i) *= 1.0 + damping;
  return equations;
}

std::optional<PoseGraph> stepped(const PoseGraph& graph, const std::vector<int>& columns, int count,
                                 double damping) {
  const Equations equations = linearise(graph, columns, count, damping);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(equations.hessian);
  if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 0.0)) return std::nullopt;
  const Eigen::VectorXd step = -solver.solve(equations.gradient);
  if (!step.allFinite()) return std::nullopt;
  PoseGraph moved = graph;
  for (std::size_t i = 0; i < moved.nodes.size(); ++i) {
    if (columns[i] < 0) continue;
    const Vector7d twist = step.segment<7>(columns[i]);
    moved.nodes[i].world_from_node = moved.nodes[i].world_from_node * geometry::exp_sim3(twist);
  }
  return moved;
}

}  // namespace

bool optimise(PoseGraph& graph, double unit) {
  PoseGraph best = graph;
  for (auto& node : best.nodes) node.world_from_node = scaled(node.world_from_node, 1.0 / unit);
  for (auto& edge : best.edges) edge.a_from_b = scaled(edge.a_from_b, 1.0 / unit);
  int count = 0;
  const std::vector<int> columns = columns_of(best, count);
  if (count == 0) return true;
  double cost = cost_of(best);
  double damping = 1e-6;
  bool improved = cost < 1e-20;
  for (int i = 0; i < kMaxIterations && damping < 1e6; ++i) {
    auto candidate = stepped(best, columns, count, damping);
    const double candidate_cost = candidate ? cost_of(*candidate) : cost;
    if (!candidate || !(candidate_cost < cost)) {
      damping *= 10.0;
      continue;
    }
    const bool converged = cost - candidate_cost < kConverged * cost;
    best = std::move(*candidate);
    cost = candidate_cost;
    damping = std::max(1e-9, 0.1 * damping);
    improved = true;
    if (converged) break;
  }
  if (!improved) return false;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    if (columns[i] < 0) continue;
    graph.nodes[i].world_from_node = scaled(best.nodes[i].world_from_node, unit);
  }
  return true;
}

}  // namespace lumibox::tracking
