#include "tracking/point_creation.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "geometry/triangulation.h"
#include "tracking/corners.h"
#include "tracking/covisibility.h"
#include "tracking/frame_search.h"
#include "tracking/patch.h"
#include "tracking/point_matcher.h"

namespace lumibox::tracking {
namespace {

constexpr double kNearest = 0.2;  // searched depths, as multiples of the median depth
constexpr double kFarthest = 20.0;
constexpr int kMaxSteps = 400;                                   // samples along an epipolar line
constexpr double kMinParallax = 0.6 * std::numbers::pi / 180.0;  // radians, for a new point
constexpr double kMinBaseline = 0.015;  // of the median depth, between keyframes that triangulate
constexpr double kMaxErrorPx = 2.0;     // reprojection of a new point, pixels of its level
constexpr double kEpipolarCorrelation = 0.85;
constexpr double kUniqueness = 0.8;   // (1 - best correlation) over (1 - second best)
constexpr double kKnownRadius = 3.0;  // pixels of the level, around where a point should be
constexpr int kMaxKnown = 1500;       // points looked for in one keyframe
constexpr int kPartners = 3;          // keyframes searched along epipolar lines
constexpr int kNeighbours = 6;        // keyframes in which new points are then looked for

/// A patch of one keyframe prepared for another.
struct PreparedPatch {
  PatchTemplate patch;
  int level = 0;  // of the target
};

std::optional<PreparedPatch> prepare(const geometry::Camera& camera, const Map::Keyframe& source,
                                     const Eigen::Vector2d& pixel, int level, double depth,
                                     const Map::Keyframe& target) {
  const geometry::Pose target_from_source =
      target.world_from_camera.inverse() * source.world_from_camera;
  const auto ray = camera.unproject(pixel);
  if (!ray) return std::nullopt;
  const auto warp =
      affine_warp(camera, Eigen::Vector3d(depth * ray->homogeneous()), target_from_source);
  if (!warp) return std::nullopt;
  const double determinant = warp->determinant();
  if (!(determinant > 1.0 / 16.0 && determinant < 16.0)) return std::nullopt;
  const double scale = std::sqrt(determinant) * static_cast<double>(1 << level);
  const int target_level =
      std::clamp(static_cast<int>(std::lround(std::log2(scale))), 0, target.pyramid->levels() - 1);
  const double ratio = static_cast<double>(1 << target_level) / static_cast<double>(1 << level);
  const auto patch =
      make_template(source.pyramid->level(level), to_level(pixel, level), warp->inverse() * ratio);
  if (!patch) return std::nullopt;
  return PreparedPatch{*patch, target_level};
}

/// Best place along the epipolar line of a ray, on the target's level; none if the line shows
/// nothing like the patch, or more than one place like it.
std::optional<Eigen::Vector2d> search_epipolar_line(const geometry::Camera& camera,
                                                    const PreparedPatch& prepared,
                                                    const hal::Image& image,
                                                    const geometry::Pose& source_from_world,
                                                    const geometry::FramePose& target,
                                                    const Eigen::Vector3d& ray, double depth) {
  const geometry::Pose world_from_source = source_from_world.inverse();
  const geometry::Pose target_from_source = target.camera_from_world * world_from_source;
  const double nearest = 1.0 / (kNearest * depth);
  const double farthest = 1.0 / (kFarthest * depth);
  const auto at = [&](double inverse_depth) -> std::optional<Eigen::Vector2d> {
    const auto pixel = geometry::project(camera, target, world_from_source * (ray / inverse_depth));
    if (!pixel || !camera.contains(*pixel, 0.0)) return std::nullopt;
    return to_level(*pixel, prepared.level);
  };
  double best = -1.0;
  double second = -1.0;
  Eigen::Vector2d best_pixel = Eigen::Vector2d::Zero();
  std::optional<Eigen::Vector2d> previous;
  // Equal steps of inverse depth are nearly equal steps along the line; the number of steps is
  // what a pixel each needs at the focal length's scale.
  const double length = (nearest - farthest) * target_from_source.translation.norm() *
                        camera.profile().fx / static_cast<double>(1 << prepared.level);
  const int steps = std::clamp(static_cast<int>(length), 4, kMaxSteps);
  for (int i = 0; i <= steps; ++i) {
    const auto pixel = at(farthest + (nearest - farthest) * i / steps);
    if (!pixel || (previous && (*pixel - *previous).squaredNorm() < 0.6)) continue;
    previous = pixel;
    const auto correlation = correlation_at(image, prepared.patch, *pixel);
    if (!correlation) continue;
    if (*correlation > best) {
      if ((*pixel - best_pixel).squaredNorm() > 9.0) second = best;
      best = *correlation;
      best_pixel = *pixel;
    } else if (*correlation > second && (*pixel - best_pixel).squaredNorm() > 9.0) {
      second = *correlation;
    }
  }
  const auto refined = search_square(image, prepared.patch, best_pixel, 1.5);
  if (best < kMinCorrelation || !refined || refined->correlation < kEpipolarCorrelation ||
      1.0 - refined->correlation > kUniqueness * (1.0 - second)) {
    return std::nullopt;
  }
  return align_patch(image, prepared.patch, refined->pixel);
}

double error_px(const geometry::Camera& camera, const geometry::FramePose& pose,
                const Eigen::Vector3d& point, const Eigen::Vector2d& pixel) {
  const auto projected = geometry::project(camera, pose, point);
  return projected ? (*projected - pixel).norm() : 1e9;
}

/// Position of a corner of one keyframe from its match in another; adds nothing to the map.
struct NewPoint {
  Eigen::Vector3d position;
  Sighting partner;
};

std::optional<NewPoint> triangulate_corner(const geometry::Camera& camera, const Map& map,
                                           KeyframeId id, const Corner& corner,
                                           KeyframeId partner_id) {
  const Map::Keyframe& keyframe = map.keyframe(id);
  const Map::Keyframe& partner = map.keyframe(partner_id);
  const Eigen::Vector2d pixel = from_level(corner.pixel, corner.level);
  const auto ray = camera.unproject(pixel);
  if (!ray) return std::nullopt;
  const auto prepared =
      prepare(camera, keyframe, pixel, corner.level, keyframe.median_depth, partner);
  if (!prepared) return std::nullopt;
  const geometry::FramePose pose = keyframe.frame_pose();
  const geometry::FramePose partner_pose = partner.frame_pose();
  const geometry::Pose camera_from_world = geometry::pose_at_row(camera, pose, pixel.y());
  const auto found = search_epipolar_line(
      camera, *prepared, partner.pyramid->level(prepared->level), camera_from_world, partner_pose,
      ray->homogeneous(), keyframe.median_depth);
  if (!found) return std::nullopt;
  const Eigen::Vector2d partner_pixel = from_level(*found, prepared->level);
  const auto partner_ray = camera.unproject(partner_pixel);
  if (!partner_ray) return std::nullopt;
  const geometry::Pose partner_from_world =
      geometry::pose_at_row(camera, partner_pose, partner_pixel.y());
  const auto point =
      geometry::triangulate(camera_from_world, partner_from_world, ray->homogeneous().normalized(),
                            partner_ray->homogeneous().normalized());
  if (!point ||
      geometry::parallax_angle(camera_from_world, partner_from_world, *point) < kMinParallax ||
      error_px(camera, pose, *point, pixel) > kMaxErrorPx * (1 << corner.level) ||
      error_px(camera, partner_pose, *point, partner_pixel) >
          kMaxErrorPx * (1 << prepared->level)) {
    return std::nullopt;
  }
  return NewPoint{*point, {partner_id, partner_pixel, prepared->level}};
}

/// Cells of a keyframe, per level, that already show a point.
class OccupiedCells {
 public:
  OccupiedCells(const geometry::Camera& camera, const Map& map, KeyframeId id)
      : columns_(camera.width() / kCell + 1), rows_(camera.height() / kCell + 1) {
    const Map::Keyframe& keyframe = map.keyframe(id);
    cells_.resize(static_cast<std::size_t>(keyframe.pyramid->levels()));
    for (auto& level : cells_) level.resize(static_cast<std::size_t>(columns_ * rows_));
    for (const PointId point : keyframe.points) {
      const Sighting& s = *map.point(point).sighting_in(id);
      mark(to_level(s.pixel, s.level), s.level);
    }
  }
  void mark(const Eigen::Vector2d& pixel, int level) { cell(pixel, level) = true; }
  bool occupied(const Eigen::Vector2d& pixel, int level) { return cell(pixel, level); }

 private:
  static constexpr int kCell = 20;  // pixels of the level
  std::vector<bool>::reference cell(const Eigen::Vector2d& pixel, int level) {
    const int x = std::clamp(static_cast<int>(pixel.x()) / kCell, 0, columns_ - 1);
    const int y = std::clamp(static_cast<int>(pixel.y()) / kCell, 0, rows_ - 1);
    return cells_[static_cast<std::size_t>(level)][static_cast<std::size_t>(y * columns_ + x)];
  }
  int columns_;
  int rows_;
  std::vector<std::vector<bool>> cells_;
};

/// Keyframes to triangulate with: those that share points and lie far enough away, nearest first.
std::vector<KeyframeId> partners_of(const Map& map, KeyframeId id) {
  const Map::Keyframe& keyframe = map.keyframe(id);
  std::vector<KeyframeId> partners;
  const auto distance = [&](KeyframeId k) {
    return (map.keyframe(k).world_from_camera.translation - keyframe.world_from_camera.translation)
        .norm();
  };
  for (const KeyframeId k : covisible_keyframes(map, id, 10)) {
    if (distance(k) > kMinBaseline * keyframe.median_depth) partners.push_back(k);
  }
  std::stable_sort(partners.begin(), partners.end(),
                   [&](KeyframeId a, KeyframeId b) { return distance(a) < distance(b); });
  if (partners.size() > kPartners) partners.resize(kPartners);
  return partners;
}

}  // namespace

void find_known_points(const geometry::Camera& camera, Map& map, KeyframeId id,
                       const MapView& candidates) {
  const Map::Keyframe& keyframe = map.keyframe(id);
  const geometry::FramePose pose = keyframe.frame_pose();
  const SearchResult found = search_map(camera, candidates, *keyframe.pyramid, pose,
                                        {0, kKnownRadius, kMaxKnown, kEpipolarCorrelation});
  for (const Measurement& m : found.measurements) {
    if (error_px(camera, pose, m.position, m.pixel) > kMaxErrorPx * (1 << m.level)) {
      continue;
    }
    map.add_sighting(candidates.points[m.point].id, {id, m.pixel, m.level});
  }
}

std::vector<PointId> create_points(const geometry::Camera& camera, const config::Tracking& options,
                                   Map& map, KeyframeId id) {
  std::vector<PointId> created;
  find_known_points(camera, map, id, map.view(0));
  const std::vector<KeyframeId> partners = partners_of(map, id);
  OccupiedCells occupied(camera, map, id);
  const std::vector<Corner> corners = detect_corners(
      *map.keyframe(id).pyramid, options.fast_threshold, options.max_features_per_keyframe);
  for (const Corner& corner : corners) {
    if (occupied.occupied(corner.pixel, corner.level)) continue;
    for (const KeyframeId partner : partners) {
      const auto point = triangulate_corner(camera, map, id, corner, partner);
      if (!point) continue;
      const PointId point_id = map.add_point(point->position);
      map.add_sighting(point_id, {id, from_level(corner.pixel, corner.level), corner.level});
      map.add_sighting(point_id, point->partner);
      occupied.mark(corner.pixel, corner.level);
      created.push_back(point_id);
      break;
    }
  }
  for (const KeyframeId neighbour : covisible_keyframes(map, id, kNeighbours)) {
    find_known_points(camera, map, neighbour, map.view_of(created));
  }
  return created;
}

}  // namespace lumibox::tracking
