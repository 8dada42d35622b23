#include "geometry/homography.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace lumibox::geometry {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Fraction of the pairs that may lie behind the plane's horizon, as outliers do.
constexpr double kMaxBehind = 0.1;

/// Middle singular value 1, and most pairs mapped forwards.
std::optional<Matrix3d> normalise(const Matrix3d& homography, std::span<const BearingPair> pairs) {
  const double middle = Eigen::JacobiSVD<Matrix3d>(homography).singularValues()[1];
  if (!(middle > 1e-9 * homography.norm())) return std::nullopt;
  const auto forwards = std::ranges::count_if(pairs, [&](const BearingPair& pair) {
    return pair.second.dot(homography * pair.first) > 0.0;
  });
  const bool flip = 2 * forwards < static_cast<std::ptrdiff_t>(pairs.size());
  return homography * ((flip ? -1.0 : 1.0) / middle);
}

/// The unit vectors that H^T H = V diag(s) V^T maps without changing their length: columns of the
/// two planes whose bases are (v2, u+) and (v2, u-).
struct IsometricPlanes {
  Vector3d shared;
  Vector3d plus;
  Vector3d minus;
};

std::optional<IsometricPlanes> isometric_planes(const Matrix3d& homography) {
  const Eigen::JacobiSVD<Matrix3d> svd(homography, Eigen::ComputeFullV);
  const Vector3d s2 = svd.singularValues().cwiseAbs2();
  const double spread = s2[0] - s2[2];
  if (!(spread > 2e-6)) return std::nullopt;
  const Vector3d along_first =
      std::sqrt(std::max(1.0 - s2[2], 0.0) / spread) * svd.matrixV().col(0);
  const Vector3d along_last = std::sqrt(std::max(s2[0] - 1.0, 0.0) / spread) * svd.matrixV().col(2);
  return IsometricPlanes{svd.matrixV().col(1), along_first + along_last, along_first - along_last};
}

/// The motion whose plane's directions include `a` and `b`, which H only rotates.
std::optional<PlaneMotion> motion_from(const Matrix3d& homography, const Vector3d& a,
                                       const Vector3d& b) {
  PlaneMotion motion;
  motion.normal = a.cross(b).normalized();
  Matrix3d before;
  before << a, b, a.cross(b);
  Matrix3d after;
  after << homography * a, homography * b, (homography * a).cross(homography * b);
  const Matrix3d rotation = after * before.transpose();
  const Vector3d translation = (homography - rotation) * motion.normal;
  const double length = translation.norm();
  if (!(length > 1e-6)) return std::nullopt;
  motion.second_from_first = Pose(rotation, translation / length);
  return motion;
}

}  // namespace

std::optional<Matrix3d> fit_homography(std::span<const BearingPair> pairs) {
  if (pairs.size() < 4) return std::nullopt;
  Matrix9d normal_matrix = Matrix9d::Zero();
  for (const BearingPair& pair : pairs) {
    // I - second second^T projects onto the tangent plane, so the 9x9 sum is a Kronecker product.
    const Matrix3d first = pair.first * pair.first.transpose();
    const Matrix3d across = Matrix3d::Identity() - pair.second * pair.second.transpose();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) normal_matrix.block<3, 3>(3 * i, 3 * j) += across(i, j) * first;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Matrix9d> eigen(normal_matrix);
  // Two small eigenvalues mean a family of solutions.
  if (!(eigen.eigenvalues()[1] > 1e-12 * eigen.eigenvalues()[8])) return std::nullopt;
  const Eigen::Matrix<double, 9, 1> entries = eigen.eigenvectors().col(0);
  return normalise(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(entries.data()),
                   pairs);
}

Eigen::Quaterniond fit_rotation(std::span<const BearingPair> pairs) {
  Matrix3d correlation = Matrix3d::Zero();
  for (const BearingPair& pair : pairs) correlation += pair.second * pair.first.transpose();
  const Eigen::JacobiSVD<Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) = -u.col(2);
  return Eigen::Quaterniond(Matrix3d(u * svd.matrixV().transpose())).normalized();
}

std::vector<PlaneMotion> motions_of_homography(const Matrix3d& homography,
                                               std::span<const BearingPair> pairs) {
  const auto planes = isometric_planes(homography);
  if (!planes) return {};
  std::vector<PlaneMotion> motions;
  for (const Vector3d& direction : {planes->plus, planes->minus}) {
    auto motion = motion_from(homography, planes->shared, direction);
    if (!motion) continue;
    const auto in_front = std::ranges::count_if(
        pairs, [&](const BearingPair& pair) { return motion->normal.dot(pair.first) > 0.0; });
    double fraction = static_cast<double>(in_front) / static_cast<double>(pairs.size());
    if (fraction < 0.5) {  // (n, t) and (-n, -t) are the same homography
      motion->normal = -motion->normal;
      motion->second_from_first.translation = -motion->second_from_first.translation;
      fraction = 1.0 - fraction;
    }
    if (fraction >= 1.0 - kMaxBehind) motions.push_back(*motion);
  }
  return motions;
}

}  // namespace lumibox::geometry
