#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "geometry/bearing_pair.h"
#include "geometry/pose.h"

namespace lumibox::geometry {

/// Synthetic views for tests: a camera with a field of view of about 60 degrees before points in
/// its own frame, seeded.
class TwoViewScene {
 public:
  explicit TwoViewScene(std::uint32_t seed) : generator_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  double normal() { return std::normal_distribution<double>(0.0, 1.0)(generator_); }
  Eigen::Vector3d direction() {
    Eigen::Vector3d v;
    do {
      v = {normal(), normal(), normal()};
    } while (v.norm() < 0.1);
    return v.normalized();
  }

  /// Points between the two depths.
  std::vector<Eigen::Vector3d> volume(int count, double near, double far) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < count; ++i) {
      points.push_back(Eigen::Vector3d(uniform(-0.6, 0.6), uniform(-0.45, 0.45), 1.0) *
                       uniform(near, far));
    }
    return points;
  }
  /// Points on normal . x = offset.
  std::vector<Eigen::Vector3d> on_plane(int count, const Eigen::Vector3d& normal_of_plane,
                                        double offset) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d ray(uniform(-0.6, 0.6), uniform(-0.45, 0.45), 1.0);
      points.push_back(ray * (offset / normal_of_plane.dot(ray)));
    }
    return points;
  }

  /// Unit vector towards a point, `sigma_rad` of noise on each coordinate across it.
  Eigen::Vector3d look(const Eigen::Vector3d& point, double sigma_rad) {
    const Eigen::Vector3d exact = point.normalized();
    return (exact + tangent_basis(exact) * Eigen::Vector2d(normal(), normal()) * sigma_rad)
        .normalized();
  }
  std::vector<BearingPair> observe(const std::vector<Eigen::Vector3d>& points,
                                   const Pose& second_from_first, double sigma_rad) {
    std::vector<BearingPair> pairs;
    for (const Eigen::Vector3d& point : points) {
      pairs.push_back({look(point, sigma_rad), look(second_from_first * point, sigma_rad)});
    }
    return pairs;
  }
  /// Replaces the second bearing of the first `count` pairs by one from anywhere in the view.
  void spoil(std::vector<BearingPair>* pairs, int count) {
    for (int i = 0; i < count; ++i) {
      (*pairs)[static_cast<std::size_t>(i)].second =
          Eigen::Vector3d(uniform(-0.6, 0.6), uniform(-0.45, 0.45), 1.0).normalized();
    }
  }

 private:
  std::mt19937 generator_;
};

}  // namespace lumibox::geometry
