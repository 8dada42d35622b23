#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/bearing_pair.h"
#include "geometry/pose.h"

namespace lumibox::geometry {

/// Essential matrices E, second^T E first = 0, that fit five pairs: at most ten, of Frobenius norm
/// sqrt(2). The four-dimensional null space of the linear constraints is cut by the ten cubic ones;
/// their Groebner basis gives the solutions as eigenvectors (Stewenius, Engels and Nister, "Recent
/// developments on direct relative orientation", ISPRS 2006). Works for points on a plane. Empty
/// where the pairs are degenerate, e.g. repeated.
std::vector<Eigen::Matrix3d> solve_essential(const std::array<BearingPair, 5>& pairs);

/// [translation] x rotation.
Eigen::Matrix3d essential_from_motion(const Pose& second_from_first);

/// The four motions second_from_first, translation of unit length, that an essential matrix allows
/// (Hartley and Zisserman, 9.6.2); at most one of them has a given point in front of both cameras.
std::array<Pose, 4> motions_of_essential(const Eigen::Matrix3d& essential);

/// Squared distance in radians^2 of a pair from the nearest pair that satisfies second^T E first =
/// 0 (Sampson's approximation, for bearings that move on the unit sphere). One degree of freedom.
inline double essential_error2(const Eigen::Matrix3d& essential, const BearingPair& pair) {
  const Eigen::Vector3d line = essential * pair.first;
  const double residual = pair.second.dot(line);
  const double slope2 = line.squaredNorm() + (essential.transpose() * pair.second).squaredNorm() -
                        2.0 * residual * residual;
  // Zero only where both bearings point at their epipoles: such a pair fits every motion.
  return slope2 > 1e-30 ? residual * residual / slope2 : 0.0;
}

}  // namespace lumibox::geometry
