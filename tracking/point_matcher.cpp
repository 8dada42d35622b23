#include "tracking/point_matcher.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lumibox::tracking {
namespace {

/// Index of the sighting to compare with: the oldest from within 7 degrees of the new direction of
/// view, for every change of template adds its error to the point's place, else the nearest; -1
/// beyond 60 degrees, where even a flat patch is foreshortened to half.
int choose_sighting(const MapView& map, const Eigen::Vector3d& position,
                    std::span<const Sighting> sightings, const Eigen::Vector3d& center) {
  constexpr double kNearEnough = 0.9925;  // cosine of 7 degrees
  const Eigen::Vector3d wanted = (center - position).normalized();
  double best_cosine = 0.5;
  int best = -1;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const auto& keyframe = map.keyframes[static_cast<std::size_t>(sightings[i].keyframe)];
    const double cosine =
        wanted.dot((keyframe.world_from_camera.translation - position).normalized());
    if (cosine > kNearEnough) return static_cast<int>(i);
    if (cosine > best_cosine) {
      best_cosine = cosine;
      best = static_cast<int>(i);
    }
  }
  return best;
}

}  // namespace

std::optional<Eigen::Matrix2d> affine_warp(const geometry::Camera& camera,
                                           const Eigen::Vector2d& pixel, double depth,
                                           const geometry::Pose& target_from_source) {
  constexpr double kStep = 4.0;  // half a patch: the finite difference spans what is compared
  const auto image_of = [&](const Eigen::Vector2d& offset) -> std::optional<Eigen::Vector2d> {
    const auto ray = camera.unproject(pixel + offset);
    if (!ray) return std::nullopt;
    return camera.project(target_from_source * Eigen::Vector3d(depth * ray->homogeneous()));
  };
  const auto center = image_of(Eigen::Vector2d::Zero());
  const auto right = image_of(Eigen::Vector2d(kStep, 0.0));
  const auto down = image_of(Eigen::Vector2d(0.0, kStep));
  if (!center || !right || !down) return std::nullopt;
  Eigen::Matrix2d warp;
  warp.col(0) = (*right - *center) / kStep;
  warp.col(1) = (*down - *center) / kStep;
  return warp;
}

std::optional<PatchWarp> plan_warp(const geometry::Camera& camera, const MapView& map,
                                   const Eigen::Vector3d& position,
                                   std::span<const Sighting> sightings,
                                   const geometry::Pose& camera_from_world, int min_level) {
  const int chosen =
      choose_sighting(map, position, sightings, camera_from_world.inverse().translation);
  if (chosen < 0) return std::nullopt;
  const Sighting& sighting = sightings[static_cast<std::size_t>(chosen)];
  const auto& keyframe = map.keyframes[static_cast<std::size_t>(sighting.keyframe)];
  const double depth = (keyframe.camera_from_world * position).z();
  if (!(depth > 0.0)) return std::nullopt;

  const auto warp =
      affine_warp(camera, sighting.pixel, depth, camera_from_world * keyframe.world_from_camera);
  if (!warp) return std::nullopt;
  const double determinant = warp->determinant();
  if (!(determinant > 1.0 / 16.0 && determinant < 16.0)) return std::nullopt;

  PatchWarp result;
  const int top = keyframe.pyramid->levels() - 1;
  result.source = keyframe.pyramid.get();
  result.source_level = std::clamp(std::max(sighting.level, min_level), 0, top);
  // Scale of the template as seen on level 0, rounded to the level that undoes it.
  const double scale = std::sqrt(determinant) * static_cast<double>(1 << result.source_level);
  result.target_level = std::clamp(static_cast<int>(std::lround(std::log2(scale))), min_level, top);
  result.source_pixel = to_level(sighting.pixel, result.source_level);
  const double level_ratio =
      static_cast<double>(1 << result.target_level) / static_cast<double>(1 << result.source_level);
  result.source_from_target = warp->inverse() * level_ratio;
  return result;
}

}  // namespace lumibox::tracking
