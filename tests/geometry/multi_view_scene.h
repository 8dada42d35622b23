#pragma once

#include <Eigen/Core>
#include <Eigen/SVD>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/homography.h"
#include "geometry/pose.h"
#include "geometry/two_view_scene.h"

namespace lumibox::geometry {

/// Points and cameras that see all of them, the first at the origin.
struct MultiViewScene {
  std::vector<Eigen::Vector3d> points;  ///< in the first camera's frame
  std::vector<Pose> views;              ///< view_from_first, without the first

  /// Bearings by view and point, the first view's exact, the others' with `sigma_rad` of noise.
  std::vector<std::vector<Eigen::Vector3d>> look(double sigma_rad, std::uint32_t seed) const {
    TwoViewScene noise(seed + 7919);
    std::vector<std::vector<Eigen::Vector3d>> bearings(1 + views.size());
    for (const Eigen::Vector3d& point : points) {
      bearings[0].push_back(point.normalized());
      for (std::size_t v = 0; v < views.size(); ++v) {
        bearings[v + 1].push_back(noise.look(views[v] * point, sigma_rad));
      }
    }
    return bearings;
  }
};

/// A hand that goes sideways by 0.15 in all before points 2 to 6 away, not quite straight, turning
/// a little.
inline MultiViewScene sideways_scene(std::uint32_t seed, int points, int views) {
  TwoViewScene random(seed);
  MultiViewScene scene;
  scene.points = random.volume(points, 2.0, 6.0);
  const Eigen::Vector3d way = (Eigen::Vector3d::UnitX() + 0.3 * random.direction()).normalized();
  const Eigen::Vector3d turn = 0.03 * random.direction();
  const Eigen::Vector3d bend = 0.2 * random.direction();
  for (int v = 1; v <= views; ++v) {
    const double share = static_cast<double>(v) / static_cast<double>(views);
    scene.views.emplace_back(exp_so3(share * turn),
                             -0.15 * share * (way + share * (1.0 - share) * bend));
  }
  return scene;
}

/// Whether a motion found on the plane `normal_over_distance` . x = 1 (first camera's frame) is the
/// other one that moves the plane as the true motion does: nearer to that than to the truth.
inline bool is_dual(const Pose& found, const Pose& truth,
                    const Eigen::Vector3d& normal_over_distance) {
  const Eigen::Matrix3d homography =
      truth.matrix3() + truth.translation * normal_over_distance.transpose();
  const double scale = Eigen::JacobiSVD<Eigen::Matrix3d>(homography).singularValues()[1];
  const std::vector<BearingPair> ahead{{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ()}};
  const double error = angle_between(found.translation, truth.translation);
  double to_dual = 4.0;  // more than half a turn: where there is none
  for (const PlaneMotion& motion : motions_of_homography(homography / scale, ahead)) {
    const Eigen::Vector3d& way = motion.second_from_first.translation;
    if (angle_between(way, truth.translation) < 1e-3) continue;
    to_dual = std::min(to_dual, angle_between(found.translation, way));
  }
  return to_dual < error;
}

}  // namespace lumibox::geometry
