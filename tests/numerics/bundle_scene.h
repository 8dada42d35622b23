#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "tracking/bundle_adjustment.h"

namespace lumibox::tracking {

/// Cameras on an arc before points around (0.6, 0, 4), seen with `noise_px`; the first two are
/// fixed.
inline BundleProblem bundle_scene(const geometry::Camera& camera, int views, int points,
                                  double noise_px) {
  BundleProblem problem;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (int i = 0; i < views; ++i) {
    geometry::Vector6d twist;
    twist << -0.3 * i, 0.02 * i, 0.05 * i * i, 0.0, 0.08 * i, 0.01 * i;
    problem.views.push_back({geometry::exp_se3(twist), i < 2});
  }
  for (int i = 0; i < points; ++i) {
    problem.points.emplace_back(0.6 + unit(random), unit(random), 4.0 + unit(random));
  }
  for (int v = 0; v < views; ++v) {
    for (int p = 0; p < points; ++p) {
      const auto pixel =
          camera.project(problem.views[static_cast<std::size_t>(v)].camera_from_world *
                         problem.points[static_cast<std::size_t>(p)]);
      const Eigen::Vector2d error(noise(random), noise(random));
      if (pixel) problem.observations.push_back({v, p, *pixel + noise_px * error, 1.0, {}, 0.0});
    }
  }
  return problem;
}

/// Moves points and free views by `sigma` in each coordinate.
inline BundleProblem perturbed(BundleProblem problem, double sigma) {
  std::mt19937 random(5);
  std::normal_distribution<double> gauss(0.0, sigma);
  for (auto& view : problem.views) {
    if (view.fixed) continue;
    geometry::Vector6d twist;
    for (int i = 0; i < 6; ++i) twist[i] = gauss(random);
    view.camera_from_world = geometry::exp_se3(twist) * view.camera_from_world;
  }
  for (auto& point : problem.points) {
    for (int i = 0; i < 3; ++i) point[i] += gauss(random);
  }
  return problem;
}

/// The same problem in a world moved by a similarity.
inline BundleProblem moved(BundleProblem problem, const geometry::Similarity& new_from_old) {
  for (auto& view : problem.views) {
    view.camera_from_world = (new_from_old * view.camera_from_world.inverse()).inverse();
  }
  for (auto& point : problem.points) point = new_from_old * point;
  return problem;
}

/// Root of the mean squared distance of the points.
inline double rms_distance(const BundleProblem& a, const BundleProblem& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    sum += (a.points[i] - b.points[i]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(a.points.size()));
}

/// The same of the views' centres.
inline double rms_distance_of_views(const BundleProblem& a, const BundleProblem& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    sum += (a.views[i].camera_from_world.inverse().translation -
            b.views[i].camera_from_world.inverse().translation)
               .squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(a.views.size()));
}

}  // namespace lumibox::tracking
