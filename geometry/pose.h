#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/rotation.h"

namespace lumibox::geometry {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector7d = Eigen::Matrix<double, 7, 1>;

/// A rigid transform, element of SE(3); variables are named target_from_source, so that
/// `point_in_world = world_from_camera * point_in_camera`. The quaternion is unit.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Pose() = default;
  Pose(const Eigen::Quaterniond& q, const Eigen::Vector3d& t) : rotation(q), translation(t) {}
  Pose(const Eigen::Matrix3d& r, const Eigen::Vector3d& t) : rotation(r), translation(t) {
    rotation.normalize();
  }

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation;
  }
  /// Composition; the quaternion is renormalised, so long products do not drift.
  Pose operator*(const Pose& other) const {
    return {(rotation * other.rotation).normalized(), rotation * other.translation + translation};
  }
  Pose inverse() const {
    const Eigen::Quaterniond back = rotation.conjugate();
    return {back, -(back * translation)};
  }
  Eigen::Matrix3d matrix3() const { return rotation.toRotationMatrix(); }
  Eigen::Matrix4d matrix4() const;
};

/// Exponential of a twist (translation part first, then rotation), Eade, "Lie groups for 2D and
/// 3D transformations", 2013. Exact to rounding at every angle, zero included.
Pose exp_se3(const Vector6d& twist);

/// Inverse of exp_se3 with rotation angle in [0, pi].
Vector6d log_se3(const Pose& pose);

/// A similarity, element of Sim(3): x -> scale * rotation * x + translation.
struct Similarity {
  double scale = 1.0;
  Pose rigid;  ///< rotation and translation; applied after scaling

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rigid.rotation * (scale * point) + rigid.translation;
  }
  /// The pose of a camera after the world it lives in has been moved by this similarity.
  Pose operator*(const Pose& world_from_camera) const {
    return {(rigid.rotation * world_from_camera.rotation).normalized(),
            *this * world_from_camera.translation};
  }
  /// Composition; the quaternion is renormalised, as that of a Pose is.
  Similarity operator*(const Similarity& other) const {
    return {
        scale * other.scale,
        {(rigid.rotation * other.rigid.rotation).normalized(), *this * other.rigid.translation}};
  }
  Similarity inverse() const;
};

/// Exponential of a twist with growth (translation part, rotation, logarithm of scale), Strasdat,
/// Montiel and Davison, "Scale drift-aware large scale monocular SLAM", 2010. Exact to rounding at
/// every angle and scale, zero and 1 included.
Similarity exp_sim3(const Vector7d& twist);

/// Inverse of exp_sim3 with rotation angle in [0, pi]. Precondition: scale > 0.
Vector7d log_sim3(const Similarity& similarity);

/// Least-squares similarity with target ~ result * source (Umeyama, PAMI 1991). Columns are points;
/// the sets correspond column by column. Rotation is proper even for planar or reflected sets; with
/// fewer than 2 distinct points the scale is 1, with collinear points the free rotation is
/// arbitrary.
Similarity align_umeyama(const Eigen::Matrix3Xd& source, const Eigen::Matrix3Xd& target);

}  // namespace lumibox::geometry
