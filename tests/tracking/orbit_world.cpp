#include "tracking/orbit_world.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "tracking/corners.h"
#include "tracking/textured_world.h"

namespace lumibox::tracking::testing {
namespace {

constexpr double kRadius = 0.7;  // of the can
constexpr double kOrbit = 2.0;   // of the walk
constexpr int kLevels = 3;
constexpr int kSeenBy = 6;  // keyframes one after the other

}  // namespace

std::optional<Eigen::Vector3d> Can::hit(const Eigen::Vector3d& origin,
                                        const Eigen::Vector3d& direction) const {
  const double a = direction.x() * direction.x() + direction.z() * direction.z();
  const double b = origin.x() * direction.x() + origin.z() * direction.z();
  const double c = origin.x() * origin.x() + origin.z() * origin.z() - kRadius * kRadius;
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return std::nullopt;
  return Eigen::Vector3d(origin + (-b - std::sqrt(discriminant)) / a * direction);
}

hal::Image Can::render(const geometry::Camera& camera,
                       const geometry::Pose& world_from_camera) const {
  hal::Image image(camera.width(), camera.height(), 1);
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      const auto ray = camera.unproject(Eigen::Vector2d(u, v));
      const auto point =
          hit(world_from_camera.translation, world_from_camera.rotation * ray->homogeneous());
      *image.at(u, v) = 128;
      if (!point) continue;
      const double around = std::numbers::pi + std::atan2(point->z(), point->x());
      const double on_label = std::fmod(around, 2.0 * std::numbers::pi / folds_);
      *image.at(u, v) =
          static_cast<std::uint8_t>(std::lround(painted(kRadius * on_label, point->y())));
    }
  }
  return image;
}

bool Can::shows(const Eigen::Vector3d& point, const Eigen::Vector3d& center) {
  const Eigen::Vector3d normal(point.x() / kRadius, 0.0, point.z() / kRadius);
  return normal.dot((center - point).normalized()) > 0.5;
}

geometry::Pose on_orbit(double angle) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()));
  return {turn, turn * Eigen::Vector3d(0.0, 0.0, -kOrbit)};
}

OrbitMap::OrbitMap(const geometry::Camera& camera, const Can& can, int keyframes, double step,
                   const geometry::Vector7d& drift) {
  for (int i = 0; i < keyframes; ++i) {
    truth.push_back(on_orbit(step * i));
    const geometry::Similarity true_place{1.0, truth.back()};
    drifted.push_back(i == 0 ? true_place
                             : drifted.back() *
                                   (geometry::Similarity{1.0, truth[truth.size() - 2]}.inverse() *
                                    true_place * geometry::exp_sim3(drift)));
    map.add_keyframe({drifted.back().rigid.inverse(), {}},
                     std::make_shared<Pyramid>(can.render(camera, truth.back()), kLevels));
  }
  for (int i = 0; i < keyframes; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const geometry::Similarity drifted_from_true =
        drifted[at] * geometry::Similarity{1.0, truth[at]}.inverse();
    for (const Corner& corner : detect_corners(*map.keyframe(i).pyramid, 20, 100)) {
      const Eigen::Vector2d pixel = from_level(corner.pixel, corner.level);
      const auto point = can.hit(truth[at].translation,
                                 truth[at].rotation * camera.unproject(pixel)->homogeneous());
      if (!point || !Can::shows(*point, truth[at].translation)) continue;
      const PointId id = map.add_point(drifted_from_true * *point);
      for (int k = i; k < std::min(i + kSeenBy, keyframes); ++k) {
        const geometry::Pose& view = truth[static_cast<std::size_t>(k)];
        const auto seen = camera.project(view.inverse() * *point);
        if (!seen || !camera.contains(*seen, 8.0) || !Can::shows(*point, view.translation)) break;
        map.add_sighting(id, {k, *seen, corner.level});
      }
      if (map.point(id).sightings.size() < 2) map.remove_point(id);
    }
  }
  map.update_depths();
}

}  // namespace lumibox::tracking::testing
