#include "tracking/map_tracking.h"

#include <utility>

#include "geometry/robust.h"

namespace lumibox::tracking {

Localiser::Localiser(const geometry::Camera& camera, const LocalisationPasses& passes)
    : passes_(passes), search_(camera), estimator_(camera) {}

std::optional<geometry::FramePose> Localiser::coarse_pose(const MapView& map, const Pyramid& frame,
                                                          const geometry::FramePose& predicted,
                                                          double radius) {
  const int coarse_level = std::min(2, frame.levels() - 1);
  search_.search(map, frame, predicted, {coarse_level, radius, passes_.coarse_points}, found_);
  const PoseEstimate estimate =
      estimator_.estimate(found_.measurements, predicted, passes_.iterations, passes_.freedom);
  if (estimate.inliers < passes_.min_coarse) return std::nullopt;
  return estimate.pose;
}

const Localisation* Localiser::localise(const MapView& map, const Pyramid& frame,
                                        const geometry::FramePose& predicted) {
  auto coarse = coarse_pose(map, frame, predicted, passes_.coarse_radius);
  if (!coarse && passes_.wide_radius > passes_.coarse_radius) {
    coarse = coarse_pose(map, frame, predicted, passes_.wide_radius);
  }
  if (!coarse) return nullptr;
  search_.search(map, frame, *coarse, {0, passes_.fine_radius, passes_.fine_points}, found_);
  // The memory goes to and fro between the two.
  std::swap(located_.attempted, found_.attempted);
  std::swap(located_.measurements, found_.measurements);
  estimate(*coarse);
  return &located_;
}

const Localisation* Localiser::with_readout(const geometry::Vector6d& twist) {
  estimate({located_.pose.camera_from_world, twist});
  return &located_;
}

void Localiser::estimate(const geometry::FramePose& start) {
  const PoseEstimate estimate =
      estimator_.estimate(located_.measurements, start, passes_.iterations, passes_.freedom);
  located_.pose = estimate.pose;
  located_.inliers = estimate.inliers;
  located_.position_sigma = estimate.position_sigma();
  depths_.clear();
  for (const Measurement& m : located_.measurements) {
    if (m.inlier) depths_.push_back((estimate.pose.camera_from_world * m.position).z());
  }
  located_.median_depth = geometry::upper_median(depths_);
}

}  // namespace lumibox::tracking
