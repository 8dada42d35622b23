#include "bench/simulated_capture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "geometry/rotation.h"
#include "hal/sim/hand_path.h"
#include "lightfield/light_field.h"

namespace lumibox::bench {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kLowest = 5.0 * kRadians;
constexpr double kHighest = 55.0 * kRadians;

bool shows_subject(const Walk& walk, const geometry::Pose& world_from_camera) {
  const auto pixel = walk.camera->project(world_from_camera.inverse() * walk.subject.center);
  return pixel && walk.camera->contains(*pixel);
}

/// Angle at the subject from a pose to the nearest recorded one of all the sets.
double angle_to_nearest(const Walk& walk, std::size_t index,
                        const std::vector<std::vector<std::size_t>>& recorded) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto center = [&](std::size_t i) { return walk.poses[i].world_from_camera.translation; };
  for (const std::vector<std::size_t>& set : recorded) {
    for (const std::size_t other : set) {
      nearest = std::min(
          nearest, lightfield::angle_at_subject(center(index), walk.subject.center, center(other)));
    }
  }
  return nearest;
}

double mean_distance(const Walk& walk) {
  double sum = 0.0;
  for (const hal::StampedPose& pose : walk.poses) {
    sum += (pose.world_from_camera.translation - walk.subject.center).norm();
  }
  return sum / static_cast<double>(walk.poses.size());
}

}  // namespace

Walk walk_of(const hal::Scene& scene) {
  Walk walk;
  walk.camera =
      std::make_shared<const geometry::Camera>(geometry::Camera(scene.profile()).undistorted());
  walk.subject.center = scene.subject().center;
  walk.subject.radius = scene.subject().radius;
  for (std::int64_t frame = 0; frame < scene.frame_count(); ++frame) {
    const double time_s = 1e-9 * static_cast<double>(scene.timestamp_ns(frame));
    walk.poses.push_back({time_s, scene.world_from_camera(time_s)});
  }
  return walk;
}

std::vector<std::size_t> recorded_along(const Walk& walk, double threshold) {
  lightfield::LightField light_field({}, walk.subject);
  std::vector<std::size_t> recorded;
  for (std::size_t i = 0; i < walk.poses.size(); ++i) {
    lightfield::Perspective perspective;
    perspective.world_from_camera = walk.poses[i].world_from_camera;
    if (!light_field.accepts(perspective.center(), threshold)) continue;
    light_field.add(perspective);
    recorded.push_back(i);
  }
  return recorded;
}

std::vector<std::size_t> unseen_along(const Walk& walk,
                                      const std::vector<std::vector<std::size_t>>& recorded,
                                      std::size_t count, double least_angle) {
  std::size_t first = 0;
  std::size_t end = walk.poses.size();
  for (const std::vector<std::size_t>& set : recorded) {
    if (set.empty()) return {};
    first = std::max(first, set.front() + 1);
    end = std::min(end, set.back());
  }
  // Of each of `count` equal stretches the pose that is farthest from all that was recorded.
  std::vector<std::size_t> views;
  for (std::size_t stretch = 0; stretch < count && first < end; ++stretch) {
    double farthest = least_angle;
    std::optional<std::size_t> view;
    const std::size_t length = end - first;
    for (std::size_t i = first + stretch * length / count;
         i < first + (stretch + 1) * length / count; ++i) {
      const double angle = angle_to_nearest(walk, i, recorded);
      if (angle <= farthest || !shows_subject(walk, walk.poses[i].world_from_camera)) continue;
      farthest = angle;
      view = i;
    }
    if (view) views.push_back(*view);
  }
  return views;
}

geometry::Pose pose_around(const Walk& walk, double azimuth, double elevation) {
  const Eigen::Vector3d direction(std::sin(azimuth) * std::cos(elevation),
                                  -std::cos(azimuth) * std::cos(elevation), std::sin(elevation));
  return hal::sim::look_at(walk.subject.center + mean_distance(walk) * direction,
                           walk.subject.center);
}

/// A spiral whose turns are golden angles covers a band of the sphere evenly (Vogel, "A better way
/// to construct the sunflower head", 1979).
std::vector<hal::StampedPose> around_subject(const Walk& walk, std::size_t count) {
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<hal::StampedPose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = static_cast<double>(i);
    const double share = (n + 0.5) / static_cast<double>(count);
    const double height = std::lerp(std::sin(kLowest), std::sin(kHighest), share);
    poses.push_back({0.0, pose_around(walk, golden_angle * n, std::asin(height))});
  }
  return poses;
}

lightfield::Perspective record(const hal::Scene& scene, const Walk& walk, int id,
                               const hal::StampedPose& pose) {
  lightfield::Perspective perspective;
  perspective.id = id;
  perspective.world_from_camera = pose.world_from_camera;
  perspective.timestamp_ns = std::llround(1e9 * pose.timestamp_s);
  perspective.camera = walk.camera;
  perspective.photo = std::make_shared<lightfield::Photo>(std::make_shared<const hal::Image>(
      scene.render_ideal(*walk.camera, pose.world_from_camera, pose.timestamp_s)));
  return perspective;
}

}  // namespace lumibox::bench
