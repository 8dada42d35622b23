#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "geometry/pose.h"
#include "tracking/pyramid.h"
#include "tracking/tracked_frame.h"

namespace lumibox::tracking {

class CornerTracks;
class FlowPicture;
struct FirstStructure;

/// Two views and the points that both see; the first camera is the world, median depth is 1.
struct InitialMap {
  struct Point {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector2d first_pixel = Eigen::Vector2d::Zero();   ///< level 0
    Eigen::Vector2d second_pixel = Eigen::Vector2d::Zero();  ///< level 0
    int level = 0;                                           ///< measured on
  };
  std::shared_ptr<const Pyramid> first;
  std::shared_ptr<const Pyramid> second;
  geometry::Pose second_from_first;
  /// Of a rolling shutter, see geometry::FramePose; from the frames beside the two.
  geometry::Vector6d first_readout_twist = geometry::Vector6d::Zero();
  geometry::Vector6d second_readout_twist = geometry::Vector6d::Zero();
  std::vector<Point> points;
};

/// Waits until the scene's shape is certain: corners of a first frame are followed until a motion
/// explains them, with depths known well enough, twice in a row (thesis 2.1 did this by hand). When
/// many corners have left the picture, those of a later frame are followed beside them and take
/// over when the first are gone.
class Initialiser {
 public:
  Initialiser(const geometry::Camera& camera, const config::Tracking& options, std::uint32_t seed);
  ~Initialiser();

  struct Progress {
    std::optional<InitialMap> map;
    TrackingReason reason = TrackingReason::MoveSideways;  ///< why there is no map yet
  };
  Progress add(const std::shared_ptr<const Pyramid>& frame, std::int64_t timestamp_ns);

 private:
  /// The last structure that was certain, awaiting a second one that agrees.
  struct Claim {
    std::int64_t timestamp_ns = 0;  ///< of its last view
    geometry::Pose last_from_first;
  };

  void begin(const std::shared_ptr<const FlowPicture>& picture, std::int64_t timestamp_ns,
             bool torn);
  static bool holds(const std::unique_ptr<CornerTracks>& tracks);
  bool is_due();
  std::optional<InitialMap> attempt(const std::shared_ptr<const Pyramid>& frame);
  std::optional<InitialMap> make_map(const std::shared_ptr<const Pyramid>& frame,
                                     const FirstStructure& structure) const;

  geometry::Camera camera_;
  config::Tracking options_;
  std::uint32_t seed_;
  std::unique_ptr<CornerTracks> tracks_;  // null before the first frame
  std::unique_ptr<CornerTracks> later_;   // of a later reference; null while tracks_ has enough
  TrackingReason reason_ = TrackingReason::MoveSideways;
  double flow_at_attempt_px_ = 0.0;
  int frames_since_attempt_ = 0;
  std::optional<Claim> claim_;
};

}  // namespace lumibox::tracking
