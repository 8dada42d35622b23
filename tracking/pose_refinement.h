#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"
#include "tracking/map_view.h"

namespace lumibox::tracking {

/// What a frame's pose was estimated from, to do it again when the map has been corrected. About 11
/// kilobytes at 700 points.
struct FrameMeasurements {
  struct Measured {
    PointId point = -1;
    Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  ///< on level 0
    int level = 0;                                    ///< it was found on
  };
  std::vector<Measured> points;
  geometry::Vector6d readout_twist = geometry::Vector6d::Zero();  ///< see geometry::FramePose
};

/// World from camera of a frame as the points say where they are now, near `start`. None if too few
/// of them are left or fit.
std::optional<geometry::Pose> refine_pose(const geometry::Camera& camera, const MapView& map,
                                          const FrameMeasurements& measured,
                                          const geometry::Pose& world_from_camera);

}  // namespace lumibox::tracking
