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
                                           const Eigen::Vector3d& point_in_source,
                                           const geometry::Pose& target_from_source) {
  Eigen::Matrix<double, 2, 3> source_by_point;
  Eigen::Matrix<double, 2, 3> target_by_point;
  if (!camera.project(point_in_source, &source_by_point) ||
      !camera.project(target_from_source * point_in_source, &target_by_point)) {
    return std::nullopt;
  }
  // In the plane z = const the point moves with the first two columns only.
  const Eigen::Matrix<double, 3, 2> plane = target_from_source.matrix3().leftCols<2>();
  const Eigen::Matrix2d source_by_plane = source_by_point.leftCols<2>();
  return target_by_point * plane * source_by_plane.inverse();
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
  const auto warp = affine_warp(camera, keyframe.camera_from_world * position,
                                camera_from_world * keyframe.world_from_camera);
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
