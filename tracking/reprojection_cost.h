#pragma once

#include <ceres/ceres.h>

#include <algorithm>
#include <array>

#include "geometry/camera.h"
#include "geometry/rotation.h"
#include "tracking/bundle_adjustment.h"

namespace lumibox::tracking {

/// Parameter block of a view: quaternion x y z w, translation.
using PoseBlock = std::array<double, 7>;

inline PoseBlock to_block(const geometry::Pose& pose) {
  const auto& q = pose.rotation;
  const auto& t = pose.translation;
  return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

inline geometry::Pose from_block(const double* b) {
  return {Eigen::Quaterniond(b[3], b[0], b[1], b[2]).normalized(),
          Eigen::Vector3d(b[4], b[5], b[6])};
}

/// The same pose where lengths are `scale` times as large.
inline geometry::Pose scaled(const geometry::Pose& pose, double scale) {
  return {pose.rotation, scale * pose.translation};
}

/// SE(3) with twists from the left. The cost below gives its derivative by the twist directly, in
/// the first six of the seven columns, so the chain through the quaternion is the identity here.
class LeftTwistManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const Eigen::Map<const geometry::Vector6d> twist(delta);
    const PoseBlock moved = to_block(geometry::exp_se3(twist) * from_block(x));
    std::copy(moved.begin(), moved.end(), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* difference) const override {
    Eigen::Map<geometry::Vector6d> twist(difference);
    twist = geometry::log_se3(from_block(y) * from_block(x).inverse());
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
};

/// Coordinates of points near a given one, in which a point seen with hardly any parallax has
/// nearly Gaussian errors and one at infinity is as good as any (Civera, Davison and Montiel,
/// "Inverse depth parametrization for monocular SLAM", IEEE T-RO 2008): two of the direction in
/// which a fixed place sees it, and the inverse of its depth along the first direction.
class InverseDepthChart {
 public:
  /// Precondition: `point` is not `origin`.
  InverseDepthChart(const Eigen::Vector3d& origin, const Eigen::Vector3d& point)
      : origin_(origin), inverse_depth_(1.0 / (point - origin).norm()) {
    const Eigen::Vector3d direction = (point - origin) * inverse_depth_;
    const Eigen::Vector3d across = direction.unitOrthogonal();
    axes_ << across, direction.cross(across), direction;
  }

  const Eigen::Vector3d& origin() const { return origin_; }

  /// Columns: the two directions across, the one along.
  const Eigen::Matrix3d& axes() const { return axes_; }

  /// Of the point that the chart was made for.
  Eigen::Vector3d coordinates() const { return {0.0, 0.0, inverse_depth_}; }

  /// The point times its inverse depth, which stays finite at infinity.
  Eigen::Vector3d scaled_point(const Eigen::Vector3d& coordinates) const {
    return coordinates.z() * origin_ + axes_ * Eigen::Vector3d(coordinates.x(), coordinates.y(), 1);
  }

  /// A point at infinity, or said by noise to be beyond, comes to lie `farthest` away, or where it
  /// was if that is farther.
  Eigen::Vector3d point(const Eigen::Vector3d& coordinates, double farthest) const {
    const double least = std::min(1.0 / farthest, inverse_depth_);
    return origin_ + axes_ * Eigen::Vector3d(coordinates.x(), coordinates.y(), 1.0) /
                         std::max(coordinates.z(), least);
  }

 private:
  Eigen::Vector3d origin_;
  double inverse_depth_;
  Eigen::Matrix3d axes_;
};

/// Reprojection error in sigmas, by a view and a point's coordinates in its chart.
class ReprojectionCost : public ceres::SizedCostFunction<2, 7, 3> {
 public:
  ReprojectionCost(const geometry::Camera& camera, const InverseDepthChart& chart,
                   const BundleProblem::Observation& observation, double unit)
      : camera_(camera),
        chart_(chart),
        pixel_(observation.pixel),
        row_from_frame_(scaled(observation.row_from_frame, 1.0 / unit)),
        inverse_sigma_(1.0 / observation.sigma_px) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const geometry::Pose view_from_world = from_block(parameters[0]);
    const Eigen::Map<const Eigen::Vector3d> coordinates(parameters[1]);
    const double inverse_depth = coordinates.z();
    // Both are the point in the camera times its inverse depth, which projects to the same pixel.
    const Eigen::Vector3d in_view = view_from_world.rotation * chart_.scaled_point(coordinates) +
                                    inverse_depth * view_from_world.translation;
    const Eigen::Vector3d in_row =
        row_from_frame_.rotation * in_view + inverse_depth * row_from_frame_.translation;
    Eigen::Matrix<double, 2, 3> by_point;
    const auto pixel = camera_.project(in_row, &by_point);
    if (!pixel) return false;  // the solver rejects the step that led here
    Eigen::Map<Eigen::Vector2d> error(residuals);
    error = (*pixel - pixel_) * inverse_sigma_;
    if (jacobians == nullptr) return true;
    by_point *= inverse_sigma_;
    const Eigen::Vector2d by_row_weight = by_point * row_from_frame_.translation;
    by_point *= row_from_frame_.matrix3();
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 7, Eigen::RowMajor>> j(jacobians[0]);
      j.leftCols<3>() = inverse_depth * by_point;
      j.middleCols<3>(3) = -by_point * geometry::skew(in_view);
      j.col(6).setZero();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>> j(jacobians[1]);
      const Eigen::Matrix<double, 2, 3> by_world = by_point * view_from_world.matrix3();
      j.leftCols<2>() = by_world * chart_.axes().leftCols<2>();
      j.col(2) =
          by_world * chart_.origin() + by_point * view_from_world.translation + by_row_weight;
    }
    return true;
  }

 private:
  const geometry::Camera& camera_;
  const InverseDepthChart& chart_;
  Eigen::Vector2d pixel_;
  geometry::Pose row_from_frame_;
  double inverse_sigma_;
};

}  // namespace lumibox::tracking
