#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <optional>

namespace lumibox::geometry {

/// Normal equations of a least-squares problem with N parameters at one state.
template <int N>
struct NormalEquations {
  Eigen::Matrix<double, N, N> hessian = Eigen::Matrix<double, N, N>::Zero();   ///< sum of J^T J
  Eigen::Matrix<double, N, 1> gradient = Eigen::Matrix<double, N, 1>::Zero();  ///< sum of J^T r
  double cost = 0.0;                                                           ///< sum of r^2

  template <int R>
  void add(const Eigen::Matrix<double, R, 1>& residual,
           const Eigen::Matrix<double, R, N>& jacobian) {
    hessian.noalias() += jacobian.transpose() * jacobian;
    gradient.noalias() += jacobian.transpose() * residual;
    cost += residual.squaredNorm();
  }
};

/// Solves hessian * step = -gradient with damping relative to the diagonal, in units in which the
/// diagonal is 1: parameters may be angles and lengths of any size. One without any influence stays
/// where it is. None if the matrix is not positive.
template <int N>
std::optional<Eigen::Matrix<double, N, 1>> damped_step(const NormalEquations<N>& equations,
                                                       double damping) {
  using Vector = Eigen::Matrix<double, N, 1>;
  const Vector unit = equations.hessian.diagonal().unaryExpr(
      [](double diagonal) { return diagonal > 0.0 ? 1.0 / std::sqrt(diagonal) : 0.0; });
  Eigen::Matrix<double, N, N> damped = unit.asDiagonal() * equations.hessian * unit.asDiagonal();
  damped.diagonal().array() += damping;
  const Eigen::LDLT<Eigen::Matrix<double, N, N>> solver(damped);
  if (!(solver.vectorD().minCoeff() > 0.0)) return std::nullopt;
  return Vector(-unit.cwiseProduct(solver.solve(unit.cwiseProduct(equations.gradient))));
}

/// Minimises a sum of squares over a state of few parameters (Levenberg-Marquardt with damping
/// relative to the diagonal, as Marquardt proposed in 1963).
///   linearise(state) -> NormalEquations<N>
///   retract(state, step) -> state
/// The returned state never has a higher cost than the start. Stops when a step lowers the cost by
/// less than 1e-12 of itself.
template <int N, typename State, typename Linearise, typename Retract>
State minimise(State state, const Linearise& linearise, const Retract& retract,
               int max_iterations) {
  NormalEquations<N> here = linearise(state);
  double damping = 1e-6;
  for (int i = 0; i < max_iterations && here.cost > 0.0; ++i) {
    const auto step = damped_step(here, damping);
    if (!step) break;
    const State next = retract(state, *step);
    const NormalEquations<N> there = linearise(next);
    if (!(there.cost < here.cost)) {
      damping *= 10.0;
      if (damping > 1e6) break;
      continue;
    }
    const bool converged = here.cost - there.cost < 1e-12 * here.cost;
    state = next;
    here = there;
    damping = damping * 0.1 > 1e-12 ? damping * 0.1 : 1e-12;
    if (converged) break;
  }
  return state;
}

}  // namespace lumibox::geometry
