#include "tracking/rolling_start.h"

#include <algorithm>

#include "tracking/bundle_adjustment.h"
#include "tracking/pose_estimator.h"

namespace lumibox::tracking {
namespace {

constexpr int kRounds = 4;  // each leaves about the readout's share of a frame of the error
constexpr int kIterations = 10;

/// Twist from the left per nanosecond at each frame: the mean of the motions before and after it,
/// at the two ends that of the one neighbour, carried on as it changes.
std::vector<geometry::Vector6d> velocities(std::span<const BundleProblem::View> views,
                                           std::span<const std::int64_t> times_ns) {
  std::vector<geometry::Vector6d> between;
  for (std::size_t i = 1; i < views.size(); ++i) {
    const double interval_ns = std::max(1e6, static_cast<double>(times_ns[i] - times_ns[i - 1]));
    between.push_back(
        geometry::log_se3(views[i].camera_from_world * views[i - 1].camera_from_world.inverse()) /
        interval_ns);
  }
  const std::size_t last = between.size() - 1;
  std::vector<geometry::Vector6d> result;
  result.push_back(between[0] + 0.5 * (between[0] - between[1]));
  for (std::size_t i = 1; i <= last; ++i) result.push_back(0.5 * (between[i - 1] + between[i]));
  result.push_back(between[last] + 0.5 * (between[last] - between[last - 1]));
  return result;
}

/// Poses of all frames as a global shutter's.
std::vector<BundleProblem::View> locate_frames(const geometry::Camera& camera,
                                               std::span<const PointPath> paths,
                                               const InitialMap& map) {
  config::CameraProfile profile = camera.profile();
  profile.readout_s = 0.0;
  const geometry::Camera global_shutter(profile);
  std::vector<BundleProblem::View> views;
  geometry::Pose pose;
  for (std::size_t frame = 0; frame < paths.front().size(); ++frame) {
    std::vector<Measurement> measurements(map.points.size());
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      measurements[i].position = map.points[i].position;
      measurements[i].pixel = paths[i][frame];
    }
    if (frame > 0) {
      pose = estimate_pose(global_shutter, measurements, pose, kIterations).pose.camera_from_world;
    }
    views.push_back({pose, frame == 0});
  }
  return views;
}

}  // namespace

void correct_for_readout(const geometry::Camera& camera, std::span<const std::int64_t> times_ns,
                         std::span<const PointPath> paths, InitialMap& map) {
  if (paths.empty() || times_ns.size() < 3) return;
  BundleProblem problem;
  problem.views = locate_frames(camera, paths, map);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    problem.points.push_back(map.points[i].position);
    for (std::size_t frame = 0; frame < paths[i].size(); ++frame) {
      problem.observations.push_back(
          {static_cast<int>(frame), static_cast<int>(i), paths[i][frame], 1.0, {}, 0.0});
    }
  }
  const double readout_ns = 1e9 * camera.profile().readout_s;
  std::vector<geometry::Vector6d> velocity;
  for (int round = 0; round < kRounds; ++round) {
    velocity = velocities(problem.views, times_ns);
    for (auto& o : problem.observations) {
      o.row_from_frame = geometry::row_from_frame(
          camera, readout_ns * velocity[static_cast<std::size_t>(o.view)], o.pixel.y());
    }
    if (!adjust(camera, problem, kIterations)) return;
  }
  map.second_from_first = problem.views.back().camera_from_world;
  map.first_readout_twist = readout_ns * velocity.front();
  map.second_readout_twist = readout_ns * velocity.back();
  for (std::size_t i = 0; i < map.points.size(); ++i) map.points[i].position = problem.points[i];
}

}  // namespace lumibox::tracking
