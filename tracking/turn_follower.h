#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "tracking/map_tracking.h"
#include "tracking/map_view.h"
#include "tracking/rotation_prior.h"

namespace lumibox::tracking {

/// Follows a camera that turns away from the map. Where there is no parallax there are no new map
/// points (thesis 2.1 names it as what PTAM loses itself in), but directions are enough to know the
/// turn: corners of the last pictures, as if infinitely far away, make a panorama to track against
/// (after Pirchheim et al., "Handling pure camera rotation in keyframe-based SLAM", ISMAR 2013).
class TurnFollower {
 public:
  TurnFollower(const geometry::Camera& camera, const config::Tracking& options);

  bool active() const { return !panorama_.keyframes.empty(); }

  /// Pictures of the panorama: what a long turn takes in memory.
  std::size_t pictures() const { return panorama_.keyframes.size(); }

  /// Begins with a picture whose orientation is known.
  void start(const std::shared_ptr<const Pyramid>& picture,
             const Eigen::Quaterniond& camera_from_world);
  void stop();

  /// Orientation of the next picture, `predicted` to within a tenth of the picture. None if no turn
  /// explains most of what should be visible: then the camera moved, or the picture is bad.
  std::optional<Eigen::Quaterniond> follow(const std::shared_ptr<const Pyramid>& picture,
                                           const Eigen::Quaterniond& predicted);

  /// The same with nothing predicted: near the picture of the panorama that looks most alike.
  std::optional<Eigen::Quaterniond> find(const std::shared_ptr<const Pyramid>& picture,
                                         const SmallImage& small);

 private:
  void extend(const std::shared_ptr<const Pyramid>& picture,
              const Eigen::Quaterniond& camera_from_world);

  geometry::Camera camera_;
  config::Tracking options_;
  Localiser localiser_;
  /// A map whose keyframes all are at the origin and whose points are unit vectors.
  MapView panorama_;
  std::vector<SmallImage> small_;  // one per keyframe
};

}  // namespace lumibox::tracking
