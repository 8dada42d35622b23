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
  /// Of the pose by a twist from the left, were all errors independent (Triggs et al., "Bundle
  /// adjustment - a modern synthesis", 2000, section 2). Few points, points in one corner of the
  /// picture, coarse levels and large residuals all make it large. Errors of the map are common to
  /// many points: the pose is off by several times this.
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();

  /// Standard deviation of the camera's place in its worst direction, in units of the world.
  double position_sigma() const;
};

/// Estimates poses; keeps its memory from one to the next.
class PoseEstimator {
 public:
  explicit PoseEstimator(const geometry::Camera& camera) : camera_(camera) {}

  /// Pose that minimises Tukey's biweight of the reprojection errors, each in pixels of its level,
  /// by iteratively reweighted least squares on SE(3) from `start`; the scale is the median
  /// absolute deviation (Klein and Murray, ISMAR 2007, section 5.4). Marks the inliers.
  ///
  /// The motion during the readout of a rolling shutter is taken from `start` and not estimated:
  /// one picture cannot tell it from a scene that is sheared a little, and errors of both would
  /// grow together.
  PoseEstimate estimate(std::span<Measurement> measurements, const geometry::FramePose& start,
                        int iterations, Freedom freedom = Freedom::All);

 private:
  /// Residuals of all measurements, each kind of number by itself.
  struct Residuals {
    std::vector<geometry::Pose> row_from_frame;  ///< of a rolling shutter; otherwise empty
    std::vector<double> x, y;                    ///< pixels of the level; infinite if not visible
    std::vector<double> length;
    std::vector<Eigen::Matrix<double, 2, 6>> jacobian;  ///< by a twist from the left
    std::vector<double> sorted;                         ///< for the median
  };

  void prepare(std::span<const Measurement> measurements, const geometry::FramePose& pose);
  void evaluate(std::span<const Measurement> measurements, const geometry::FramePose& pose);
  double robust_sigma();

  geometry::Camera camera_;
  Residuals residuals_;
};

/// The same with memory of its own.
inline PoseEstimate estimate_pose(const geometry::Camera& camera,
                                  std::span<Measurement> measurements,
                                  const geometry::FramePose& start, int iterations,
                                  Freedom freedom = Freedom::All) {
  return PoseEstimator(camera).estimate(measurements, start, iterations, freedom);
}

}  // namespace lumibox::tracking
