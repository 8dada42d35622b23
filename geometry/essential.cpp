#include "geometry/essential.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <numbers>

namespace lumibox::geometry {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Polynomials in x, y, z as coefficient vectors over these monomials:
//   linear     x y z 1
//   quadratic  x2 xy xz y2 yz z2 x y z 1
//   cubic      x3 x2y x2z xy2 xyz xz2 y3 y2z yz2 z3, then the quadratic ones
using Linear = Eigen::Matrix<double, 4, 1>;
using Quadratic = Eigen::Matrix<double, 10, 1>;
using Cubic = Eigen::Matrix<double, 20, 1>;

constexpr int kLinearTimesLinear[4][4] = {{0, 1, 2, 6}, {1, 3, 4, 7}, {2, 4, 5, 8}, {6, 7, 8, 9}};
constexpr int kQuadraticTimesLinear[10][4] = {
    {0, 1, 2, 10}, {1, 3, 4, 11},    {2, 4, 5, 12},    {3, 6, 7, 13},    {4, 7, 8, 14},
    {5, 8, 9, 15}, {10, 11, 12, 16}, {11, 13, 14, 17}, {12, 14, 15, 18}, {16, 17, 18, 19}};

Quadratic multiply(const Linear& a, const Linear& b) {
  Quadratic product = Quadratic::Zero();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) product[kLinearTimesLinear[i][j]] += a[i] * b[j];
  }
  return product;
}

Cubic multiply(const Quadratic& a, const Linear& b) {
  Cubic product = Cubic::Zero();
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 4; ++j) product[kQuadraticTimesLinear[i][j]] += a[i] * b[j];
  }
  return product;
}

/// Basis X, Y, Z, W of the matrices that satisfy the five linear constraints, row by row in
/// columns.
Eigen::Matrix<double, 9, 4> linear_null_space(const std::array<BearingPair, 5>& pairs) {
  Eigen::Matrix<double, 9, 5> constraints;
  for (int i = 0; i < 5; ++i) {
    const BearingPair& pair = pairs[static_cast<std::size_t>(i)];
    for (int row = 0; row < 3; ++row) {
      constraints.col(i).segment<3>(3 * row) = pair.second[row] * pair.first;
    }
  }
  const Eigen::HouseholderQR<Eigen::Matrix<double, 9, 5>> qr(constraints);
  Eigen::Matrix<double, 9, 4> last_columns = Eigen::Matrix<double, 9, 4>::Zero();
  last_columns.bottomRows<4>().setIdentity();
  return qr.householderQ() * last_columns;
}

/// Coefficients of det E = 0 and 2 E E^T E - trace(E E^T) E = 0 for E = x X + y Y + z Z + W.
Eigen::Matrix<double, 10, 20> cubic_constraints(const Eigen::Matrix<double, 9, 4>& basis) {
  std::array<std::array<Linear, 3>, 3> e;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) e[i][j] = basis.row(static_cast<int>(3 * i + j));
  }
  Eigen::Matrix<double, 10, 20> rows;
  const auto minor = [&e](std::size_t p, std::size_t q) -> Quadratic {  // of the first two rows
    return multiply(e[0][p], e[1][q]) - multiply(e[0][q], e[1][p]);
  };
  rows.row(0) = multiply(minor(1, 2), e[2][0]) + multiply(minor(2, 0), e[2][1]) +
                multiply(minor(0, 1), e[2][2]);
  std::array<std::array<Quadratic, 3>, 3> g;  // E E^T - trace / 2
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      g[i][j] =
          multiply(e[i][0], e[j][0]) + multiply(e[i][1], e[j][1]) + multiply(e[i][2], e[j][2]);
      g[j][i] = g[i][j];
    }
  }
  const Quadratic half_trace = 0.5 * (g[0][0] + g[1][1] + g[2][2]);
  for (std::size_t i = 0; i < 3; ++i) g[i][i] -= half_trace;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      rows.row(static_cast<int>(1 + 3 * i + j)) =
          multiply(g[i][0], e[0][j]) + multiply(g[i][1], e[1][j]) + multiply(g[i][2], e[2][j]);
    }
  }
  return rows;
}

}  // namespace

std::vector<Matrix3d> solve_essential(const std::array<BearingPair, 5>& pairs) {
  const Eigen::Matrix<double, 9, 4> basis = linear_null_space(pairs);
  const Eigen::Matrix<double, 10, 20> constraints = cubic_constraints(basis);
  const Eigen::PartialPivLU<Eigen::Matrix<double, 10, 10>> lu(constraints.leftCols<10>());
  const double smallest_pivot = lu.matrixLU().diagonal().cwiseAbs().minCoeff();
  if (!(smallest_pivot > 1e-14)) return {};
  // Each cubic monomial as a combination of the quadratic ones.
  const Eigen::Matrix<double, 10, 10> reduced = lu.solve(constraints.rightCols<10>());

  // Multiplication by x of the quadratic monomials x2 xy xz y2 yz z2 | x y z 1.
  Eigen::Matrix<double, 10, 10> times_x = Eigen::Matrix<double, 10, 10>::Zero();
  times_x.topRows<6>() = -reduced.topRows<6>();
  times_x(6, 0) = times_x(7, 1) = times_x(8, 2) = times_x(9, 6) = 1.0;
  const Eigen::EigenSolver<Eigen::Matrix<double, 10, 10>> eigen(times_x);
  if (eigen.info() != Eigen::Success) return {};

  std::vector<Matrix3d> solutions;
  for (int i = 0; i < 10; ++i) {
    if (eigen.eigenvalues()[i].imag() != 0.0) continue;
    const Eigen::Vector4d xyz1 = eigen.eigenvectors().col(i).tail<4>().real();
    const Eigen::Matrix<double, 9, 1> entries = basis * xyz1;
    const double norm = entries.norm();
    if (!(norm > 1e-12)) continue;
    solutions.push_back(
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(entries.data()) *
        (std::numbers::sqrt2 / norm));
  }
  return solutions;
}

Matrix3d essential_from_motion(const Pose& second_from_first) {
  return skew(second_from_first.translation) * second_from_first.matrix3();
}

std::array<Pose, 4> motions_of_essential(const Matrix3d& essential) {
  const Eigen::JacobiSVD<Matrix3d> svd(essential, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d u = svd.matrixU();
  Matrix3d v = svd.matrixV();
  if (u.determinant() < 0.0) u.col(2) = -u.col(2);
  if (v.determinant() < 0.0) v.col(2) = -v.col(2);
  Matrix3d quarter_turn;
  quarter_turn << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  const Matrix3d one = u * quarter_turn * v.transpose();
  const Matrix3d other = u * quarter_turn.transpose() * v.transpose();
  const Vector3d t = u.col(2);
  return {Pose(one, t), Pose(one, -t), Pose(other, t), Pose(other, -t)};
}

}  // namespace lumibox::geometry
