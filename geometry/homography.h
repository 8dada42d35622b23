#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "geometry/bearing_pair.h"
#include "geometry/pose.h"

namespace lumibox::geometry {

/// Matrix H with second ~ H first, up to positive scale, for at least four pairs: the direct linear
/// transform on bearings, as least squares of the components of H first perpendicular to second.
/// Its middle singular value is 1 and its sign such that H first points along second rather than
/// against it. None where the pairs do not determine it (three on a line, repeated, fewer than
/// four).
std::optional<Eigen::Matrix3d> fit_homography(std::span<const BearingPair> pairs);

/// The rotation that turns the first bearings onto the second with least squared error (Arun, Huang
/// and Blostein, PAMI 1987); needs two pairs.
Eigen::Quaterniond fit_rotation(std::span<const BearingPair> pairs);

/// Squared distance in radians^2 of a pair from the nearest pair with second ~ H first, both
/// bearings being uncertain, for an H near a rotation. Two degrees of freedom. `inverse` is H^-1.
inline double homography_error2(const Eigen::Matrix3d& homography, const Eigen::Matrix3d& inverse,
                                const BearingPair& pair) {
  const double forward2 = ((homography * pair.first).normalized() - pair.second).squaredNorm();
  const double back2 = ((inverse * pair.second).normalized() - pair.first).squaredNorm();
  // Each transfer error carries the noise of both bearings, twice that of one.
  return 0.25 * (forward2 + back2);
}

/// A motion with the plane that makes it the cause of a homography.
struct PlaneMotion {
  Pose second_from_first;  ///< translation of unit length
  Eigen::Vector3d normal;  ///< in the first camera's frame; points on the plane have normal . x > 0
};

/// The motions H = R + t n^T / d of a homography as fit_homography scales it: two, each with the
/// plane in front for most of the given bearings (Ma, Soatto, Kosecka and Sastry, "An Invitation to
/// 3-D Vision", 5.3.3). Those that put the plane behind the camera for more than a tenth of the
/// pairs are left out. Empty if H is a rotation to within 1e-6.
std::vector<PlaneMotion> motions_of_homography(const Eigen::Matrix3d& homography,
                                               std::span<const BearingPair> pairs);

}  // namespace lumibox::geometry
