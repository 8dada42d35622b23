#include "tracking/map_tracking.h"

#include <algorithm>

namespace lumibox::tracking {
namespace {

constexpr int kCoarsePoints = 80;
constexpr int kMinCoarse = 12;         // inliers a coarse pose must have
constexpr double kCoarseRadius = 5.0;  // pixels of the coarse level; 20 to 40 pixels of the picture
constexpr double kWideRadius = 11.0;   // second try

/// Pose from a coarse pass; none if it found too few points that agree.
std::optional<geometry::FramePose> coarse_pose(const geometry::Camera& camera,
                                               const config::Tracking& options, const MapView& map,
                                               const Pyramid& frame,
                                               const geometry::FramePose& predicted,
                                               double radius) {
  const int coarse_level = std::min(2, frame.levels() - 1);
  SearchResult found =
      search_map(camera, map, frame, predicted, {coarse_level, radius, kCoarsePoints});
  const PoseEstimate estimate =
      estimate_pose(camera, found.measurements, predicted, options.pose_iterations);
  if (estimate.inliers < kMinCoarse) return std::nullopt;
  return estimate.pose;
}

}  // namespace

std::optional<Localisation> localise(const geometry::Camera& camera,
                                     const config::Tracking& options, const MapView& map,
                                     const Pyramid& frame, const geometry::FramePose& predicted) {
  auto coarse = coarse_pose(camera, options, map, frame, predicted, kCoarseRadius);
  if (!coarse) coarse = coarse_pose(camera, options, map, frame, predicted, kWideRadius);
  if (!coarse) return std::nullopt;

  SearchResult found = search_map(camera, map, frame, *coarse,
                                  {0, options.search_radius_px, options.max_measurements});
  const PoseEstimate estimate =
      estimate_pose(camera, found.measurements, *coarse, options.pose_iterations);
  return Localisation{estimate.pose, std::move(found.attempted), std::move(found.measurements),
                      estimate.inliers};
}

}  // namespace lumibox::tracking
