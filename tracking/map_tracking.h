#pragma once

#include <optional>
#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "tracking/frame_search.h"
#include "tracking/map_view.h"
#include "tracking/pose_estimator.h"

namespace lumibox::tracking {

/// A frame located in the map.
struct Localisation {
  geometry::FramePose pose;
  std::vector<std::uint32_t> attempted;   ///< points that should be visible
  std::vector<Measurement> measurements;  ///< points found; outliers are flagged
  int inliers = 0;
  double position_sigma = 0.0;  ///< see PoseEstimate; in units of the world
  double median_depth = 0.0;    ///< of the inliers

  double found_share() const {
    return attempted.empty() ? 0.0
                             : static_cast<double>(inliers) / static_cast<double>(attempted.size());
  }
};

/// How a frame is looked for around a predicted pose.
struct LocalisationPasses {
  int coarse_points = 80;
  int min_coarse = 12;         ///< inliers that a coarse pose must have
  double coarse_radius = 5.0;  ///< pixels of the coarse level; 20 to 40 pixels of the picture
  double wide_radius = 11.0;   ///< of the second try; no larger than the first: there is none
  int fine_points = 700;
  double fine_radius = 4.0;  ///< pixels of the level searched
  Freedom freedom = Freedom::All;
  int iterations = 10;  ///< of each pose, at most
};

/// Locates frames in a map, coarse to fine: few points on coarse levels with a wide search, then
/// many with a narrow one (Klein and Murray, ISMAR 2007, section 5.5). Keeps its memory from one
/// frame to the next.
class Localiser {
 public:
  Localiser(const geometry::Camera& camera, const LocalisationPasses& passes);
  Localiser(const geometry::Camera& camera, const config::Tracking& options)
      : Localiser(camera, {.fine_points = options.max_measurements,
                           .fine_radius = options.search_radius_px,
                           .iterations = options.pose_iterations}) {}

  /// Locates a frame near a predicted pose. Null if the coarse pass finds too little to go on with;
  /// what is pointed to lasts until the next frame.
  const Localisation* localise(const MapView& map, const Pyramid& frame,
                               const geometry::FramePose& predicted);

  /// The frame just located, with another motion during its readout.
  const Localisation* with_readout(const geometry::Vector6d& twist);

 private:
  std::optional<geometry::FramePose> coarse_pose(const MapView& map, const Pyramid& frame,
                                                 const geometry::FramePose& predicted,
                                                 double radius);
  void estimate(const geometry::FramePose& start);

  LocalisationPasses passes_;
  FrameSearch search_;
  PoseEstimator estimator_;
  SearchResult found_;
  Localisation located_;
  std::vector<double> depths_;
};

}  // namespace lumibox::tracking
