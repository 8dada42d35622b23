#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "geometry/pose.h"
#include "geometry/two_view.h"
#include "tracking/pyramid.h"
#include "tracking/tracked_frame.h"

namespace lumibox::tracking {

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

/// Waits for two views from which the scene's shape is certain: corners of a first frame are
/// followed until a motion with enough parallax explains them (thesis 2.1 did this by hand).
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
  struct Track;  ///< a corner followed since the first frame

  void restart(const std::shared_ptr<const Pyramid>& frame, std::int64_t timestamp_ns);
  void follow(const std::shared_ptr<const Pyramid>& frame);
  static void refine(const Pyramid& frame, Track& track);
  double median_flow_px() const;
  Progress solve(const std::shared_ptr<const Pyramid>& frame);
  std::optional<geometry::Pose> decide(const geometry::TwoViewResult& motion,
                                       std::span<const geometry::BearingPair> pairs,
                                       std::span<const Track* const> used) const;
  Progress make_map(const std::shared_ptr<const Pyramid>& frame,
                    const geometry::Pose& second_from_first, const std::vector<bool>& inliers,
                    std::span<const geometry::BearingPair> pairs,
                    std::span<const Track* const> used) const;

  geometry::Camera camera_;
  config::Tracking options_;
  std::uint32_t seed_;
  std::shared_ptr<const Pyramid> first_;
  std::shared_ptr<const Pyramid> last_;
  std::vector<Track> tracks_;
  std::size_t tracks_at_start_ = 0;
  std::vector<std::int64_t> times_ns_;  // of the frames since the first
};

}  // namespace lumibox::tracking
