#include "lightfield/opengl_axes.h"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace lumibox::lightfield {
namespace {

/// Turns the camera by half a turn about its x axis: y down and z forward become y up and z
/// backward. Its own inverse, and exact in floating point.
Eigen::Matrix3d swap_axes(const Eigen::Matrix3d& rotation) {
  return rotation * Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
}

}  // namespace

Eigen::Matrix4d world_from_opengl(const geometry::Pose& world_from_camera) {
  Eigen::Matrix4d matrix = world_from_camera.matrix4();
  matrix.topLeftCorner<3, 3>() = swap_axes(world_from_camera.matrix3());
  return matrix;
}

std::optional<geometry::Pose> pose_from_opengl(const Eigen::Matrix4d& world_from_opengl,
                                               double tolerance) {
  const Eigen::Matrix3d r = world_from_opengl.topLeftCorner<3, 3>();
  const double error = (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  // Written so that a NaN fails too.
  if (!(error <= tolerance) || !(r.determinant() > 0.0)) return std::nullopt;
  if (world_from_opengl.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return geometry::Pose(swap_axes(svd.matrixU() * svd.matrixV().transpose()),
                        world_from_opengl.topRightCorner<3, 1>());
}

}  // namespace lumibox::lightfield
