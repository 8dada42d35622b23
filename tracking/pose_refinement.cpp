#include "tracking/pose_refinement.h"

#include <algorithm>

#include "tracking/pose_estimator.h"

namespace lumibox::tracking {
namespace {

constexpr int kIterations = 10;
constexpr int kMinInliers = 40;    // as many as a pose to record with needs
constexpr double kMinShare = 0.5;  // of what was measured: the rest may be culled or merged

}  // namespace

std::optional<geometry::Pose> refine_pose(const geometry::Camera& camera, const MapView& map,
                                          const FrameMeasurements& measured,
                                          const geometry::Pose& world_from_camera) {
  std::vector<Measurement> measurements;
  for (const FrameMeasurements::Measured& m : measured.points) {
    const MapView::Point* point = find_point(map, m.point);
    if (point == nullptr) continue;
    measurements.push_back({static_cast<std::uint32_t>(point - map.points.data()), point->position,
                            m.pixel.cast<double>(), m.level, false});
  }
  const PoseEstimate estimate = estimate_pose(
      camera, measurements, {world_from_camera.inverse(), measured.readout_twist}, kIterations);
  const double needed =
      std::max<double>(kMinInliers, kMinShare * static_cast<double>(measured.points.size()));
  if (estimate.inliers < needed) return std::nullopt;
  return estimate.pose.camera_from_world.inverse();
}

}  // namespace lumibox::tracking
