#pragma once

#include <optional>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"
#include "hal/image.h"
#include "tracking/map.h"

namespace lumibox::tracking::testing {

/// A painted upright can around the origin, before nothing. Its label repeats `folds` times around.
class Can {
 public:
  explicit Can(int folds) : folds_(folds) {}

  /// Where a ray from outside meets the can; none if it does not.
  std::optional<Eigen::Vector3d> hit(const Eigen::Vector3d& origin,
                                     const Eigen::Vector3d& direction) const;

  hal::Image render(const geometry::Camera& camera, const geometry::Pose& world_from_camera) const;

  /// Whether a camera at `center` sees a point of the can, not from too much of an angle.
  static bool shows(const Eigen::Vector3d& point, const Eigen::Vector3d& center);

 private:
  int folds_;
};

/// A camera that looks at the can's axis from a circle around it, at an angle in radians.
geometry::Pose on_orbit(double angle);

/// A map of an orbit around the can, one keyframe per `step` radians, each point seen by the
/// keyframe that found it and the five after it: the end of the walk does not know the beginning.
/// Every keyframe is off from the one before by `drift`, and all that it found with it.
struct OrbitMap {
  OrbitMap(const geometry::Camera& camera, const Can& can, int keyframes, double step,
           const geometry::Vector7d& drift);

  Map map;
  std::vector<geometry::Pose> truth;          ///< world_from_camera, by KeyframeId
  std::vector<geometry::Similarity> drifted;  ///< where the drift has put them
};

}  // namespace lumibox::tracking::testing
