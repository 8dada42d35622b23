#include "geometry/rolling_shutter.h"

#include <algorithm>

namespace lumibox::geometry {

Pose row_from_frame(const Camera& camera, const Vector6d& readout_twist, double row) {
  if (camera.profile().readout_s == 0.0) return {};
  // Beyond the picture there are no rows: a wild prediction must not extrapolate the motion.
  const double time = std::clamp(readout_time(camera, row), -0.5, 0.5);
  return exp_se3(time * readout_twist);
}

Pose pose_at_row(const Camera& camera, const FramePose& frame, double row) {
  if (camera.profile().readout_s == 0.0) return frame.camera_from_world;
  return row_from_frame(camera, frame.readout_twist, row) * frame.camera_from_world;
}

std::optional<Eigen::Vector2d> project(const Camera& camera, const FramePose& frame,
                                       const Eigen::Vector3d& point_in_world) {
  const Eigen::Vector3d point = frame.camera_from_world * point_in_world;
  auto pixel = camera.project(point);
  if (camera.profile().readout_s == 0.0) return pixel;
  // The picture moves by less than a tenth of its height during a readout, so each pass leaves a
  // tenth of the error in the row: three leave less than a hundredth of a pixel.
  for (int pass = 0; pass < 3 && pixel; ++pass) {
    pixel = camera.project(row_from_frame(camera, frame.readout_twist, pixel->y()) * point);
  }
  return pixel;
}

}  // namespace lumibox::geometry
