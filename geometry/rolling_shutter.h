#pragma once

#include "geometry/camera.h"
#include "geometry/pose.h"

namespace lumibox::geometry {

/// The pose of a frame whose rows are exposed one after the other while the camera moves (Hedborg
/// et al., "Rolling shutter bundle adjustment", CVPR 2012, with a constant twist over the frame).
struct FramePose {
  Pose camera_from_world;  ///< when the middle row was exposed
  Vector6d readout_twist =
      Vector6d::Zero();  ///< from the first to the last row; 0 = global shutter

  FramePose() = default;
  // Implicit on purpose: a global shutter's pose is a frame's pose.
  FramePose(const Pose& middle) : camera_from_world(middle) {}
  FramePose(const Pose& middle, const Vector6d& twist)
      : camera_from_world(middle), readout_twist(twist) {}
};

/// Time of a row within the readout: -0.5 for the first, 0 for the middle, 0.5 for the last.
inline double readout_time(const Camera& camera, double row) {
  return camera.height() > 1 ? row / (camera.height() - 1) - 0.5 : 0.0;
}

/// Motion from the middle row to `row`: pose of the row = row_from_frame * camera_from_world.
/// Identity for a camera whose profile names no readout.
Pose row_from_frame(const Camera& camera, const Vector6d& readout_twist, double row);

/// Pose of the camera while `row` was exposed.
Pose pose_at_row(const Camera& camera, const FramePose& frame, double row);

/// Pixel of a point in world: the row at which it is seen decides the pose that sees it. None as
/// Camera::project.
std::optional<Eigen::Vector2d> project(const Camera& camera, const FramePose& frame,
                                       const Eigen::Vector3d& point_in_world);

}  // namespace lumibox::geometry
