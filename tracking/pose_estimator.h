#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/camera.h"
#include "geometry/rolling_shutter.h"

namespace lumibox::tracking {

/// A map point found in a frame.
struct Measurement {
  std::uint32_t point = 0;                             ///< index into MapView::points
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in world
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();     ///< on level 0
  int level = 0;                                       ///< it was found on
  bool inlier = false;                                 ///< set by estimate_pose
};

enum class Freedom {
  All,
  Rotation,  ///< the translation stays
};

struct PoseEstimate {
  geometry::FramePose pose;
  int inliers = 0;
  double sigma_px = 0.0;  ///< robust standard deviation of the residuals, in pixels of their level
};

/// Pose that minimises Tukey's biweight of the reprojection errors, each in pixels of its level, by
/// iteratively reweighted least squares on SE(3) from `start`; the scale is the median absolute
/// deviation (Klein and Murray, ISMAR 2007, section 5.4). Marks the inliers.
///
/// The motion during the readout of a rolling shutter is taken from `start` and not estimated: one
/// picture cannot tell it from a scene that is sheared a little, and errors of both would grow
/// together.
PoseEstimate estimate_pose(const geometry::Camera& camera, std::span<Measurement> measurements,
                           const geometry::FramePose& start, int iterations,
                           Freedom freedom = Freedom::All);

}  // namespace lumibox::tracking
