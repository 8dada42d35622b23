// What stability costs: the time of geometry's functions over that of their plain textbook forms,
// which fail in the hard cases of tests/numerics. Prints JSON lines, ratios of one run.

#include "bench/numerics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/absolute_pose.h"
#include "geometry/camera.h"
#include "geometry/pose.h"
#include "geometry/triangulation.h"
#include "geometry/two_view.h"
#include "geometry/two_view_models.h"

namespace lumibox::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Eigen::Quaterniond plain_exp(const Vector3d& v) {
  const double angle = v.norm();
  const Vector3d xyz = v * (std::sin(0.5 * angle) / angle);
  return {std::cos(0.5 * angle), xyz.x(), xyz.y(), xyz.z()};
}

Vector3d plain_log(const Eigen::Quaterniond& q) {
  return q.vec() * (2.0 * std::acos(q.w()) / std::sqrt(1.0 - q.w() * q.w()));
}

/// Strasdat's closed form, which divides by angle and growth.
Vector3d plain_exp_sim3(const Vector7d& twist) {
  const Vector3d omega = twist.segment<3>(3);
  const double angle = omega.norm();
  const double sigma = twist[6];
  const double scale = std::exp(sigma);
  const double a = scale * std::sin(angle);
  const double b = scale * std::cos(angle);
  const double c = angle * angle + sigma * sigma;
  const double along = (scale - 1.0) / sigma;
  const Eigen::Matrix3d w = skew(omega);
  const Eigen::Matrix3d v = along * Eigen::Matrix3d::Identity() +
                            (a * sigma + (1.0 - b) * angle) / (angle * c) * w +
                            (along - ((b - 1.0) * sigma + a * angle) / c) / (angle * angle) * w * w;
  return v * twist.head<3>() + scale * plain_exp(omega).vec();
}

Vector3d plain_slerp(const Vector3d& from, const Vector3d& to, double t) {
  const double angle = std::acos(from.dot(to));
  return (std::sin((1.0 - t) * angle) * from + std::sin(t * angle) * to) / std::sin(angle);
}

/// Five steps of the fixed-point iteration that OpenCV's undistortPoints takes.
Vector2d plain_unproject(const config::CameraProfile& c, const Vector2d& pixel) {
  const Vector2d target((pixel.x() - c.cx) / c.fx, (pixel.y() - c.cy) / c.fy);
  Vector2d n = target;
  for (int i = 0; i < 5; ++i) {
    const double r2 = n.squaredNorm();
    const double radial = 1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
    const double xy = 2.0 * n.x() * n.y();
    const Vector2d tangential(c.p1 * xy + c.p2 * (r2 + 2.0 * n.x() * n.x()),
                              c.p2 * xy + c.p1 * (r2 + 2.0 * n.y() * n.y()));
    n = (target - tangential) / radial;
  }
  return n;
}

/// Middle of the shortest line between the rays.
Vector3d plain_triangulate(const Pose& b_from_a, const Vector3d& in_a, const Vector3d& in_b) {
  const Pose a_from_b = b_from_a.inverse();
  const Vector3d d = a_from_b.rotation * in_b;
  const double cosine = in_a.dot(d);
  const double determinant = 1.0 - cosine * cosine;
  const double along_a =
      (a_from_b.translation.dot(in_a) - cosine * a_from_b.translation.dot(d)) / determinant;
  const double along_b =
      (cosine * a_from_b.translation.dot(in_a) - a_from_b.translation.dot(d)) / determinant;
  return 0.5 * (along_a * in_a + a_from_b.translation + along_b * d);
}

void compare_groups(Numbers* numbers) {
  constexpr std::size_t kCount = 20'000;
  std::vector<Vector3d> vectors(kCount);
  std::vector<Eigen::Quaterniond> rotations(kCount);
  std::vector<Vector7d> twists(kCount);
  std::vector<std::pair<Vector3d, Vector3d>> normals(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    vectors[i] = numbers->vector();
    rotations[i] = exp_so3(vectors[i]);
    twists[i] << numbers->vector(), vectors[i], numbers->next();
    normals[i] = {vectors[i].normalized(), numbers->vector().normalized()};
  }
  compare("exp_so3", "sin(a/2)/a", kCount,
          over(vectors, [](const Vector3d& v) { return exp_so3(v).x(); }),
          over(vectors, [](const Vector3d& v) { return plain_exp(v).x(); }));
  compare("log_so3", "2 acos(w)", kCount,
          over(rotations, [](const Eigen::Quaterniond& q) { return log_so3(q).x(); }),
          over(rotations, [](const Eigen::Quaterniond& q) { return plain_log(q).x(); }));
  compare("exp_sim3", "Strasdat's three coefficients", kCount,
          over(twists,
               [](const Vector7d& t) {
                 const Similarity s = exp_sim3(t);
                 return s.rigid.translation.x() + s.scale * s.rigid.rotation.x();
               }),
          over(twists, [](const Vector7d& t) { return plain_exp_sim3(t).x(); }));
  compare("slerp", "acos and sin", kCount,
          over(normals, [](const auto& n) { return slerp(n.first, n.second, 0.3).x(); }),
          over(normals, [](const auto& n) { return plain_slerp(n.first, n.second, 0.3).x(); }));
}

void compare_unproject(Numbers* numbers) {
  config::CameraProfile lens;
  lens.k1 = -0.28;
  lens.k2 = 0.09;
  lens.p1 = 1e-3;
  lens.p2 = -8e-4;
  const Camera camera(lens);
  std::vector<Vector2d> pixels(20'000);
  for (Vector2d& pixel : pixels) {
    pixel.x() = 0.5 * lens.width * (1.0 + numbers->next());
    pixel.y() = 0.5 * lens.height * (1.0 + numbers->next());
  }
  compare(
      "unproject", "5 fixed-point steps", pixels.size(),
      over(pixels,
           [&](const Vector2d& p) { return camera.unproject(p).value_or(Vector2d::Zero()).x(); }),
      over(pixels, [&](const Vector2d& p) { return plain_unproject(lens, p).x(); }));
}

/// A camera's step past points, some of the matches wrong.
struct Scene {
  Pose motion = Pose(exp_so3({0.02, 0.1, 0.0}), Vector3d(-0.5, 0.05, 0.1));
  std::vector<Vector3d> points;
  std::vector<BearingPair> pairs;
  std::vector<Vector3d> second;
};

Scene make_scene(Numbers* numbers, std::size_t count, std::size_t wrong) {
  Scene scene;
  for (std::size_t i = 0; i < count; ++i) {
    const double depth = 4.0 + 2.0 * numbers->next();
    scene.points.push_back(depth * Vector3d(0.6 * numbers->next(), 0.45 * numbers->next(), 1.0));
    const Vector3d seen = scene.motion * scene.points.back() + 1e-3 * depth * numbers->vector();
    scene.second.push_back(
        i < wrong ? Vector3d(0.6 * numbers->next(), 0.4 * numbers->next(), 1.0).normalized()
                  : seen.normalized());
    scene.pairs.push_back({scene.points.back().normalized(), scene.second.back()});
  }
  return scene;
}

void compare_solvers(Numbers* numbers) {
  const Scene clean = make_scene(numbers, 5'000, 0);
  compare("triangulate", "middle between the rays", clean.pairs.size(),
          over(clean.pairs,
               [&](const BearingPair& p) {
                 return triangulate(Pose(), clean.motion, p.first, p.second)
                     .value_or(Vector3d::Zero())
                     .x();
               }),
          over(clean.pairs, [&](const BearingPair& p) {
            return plain_triangulate(clean.motion, p.first, p.second).x();
          }));
  const std::vector<Scene> scenes{make_scene(numbers, 200, 40), make_scene(numbers, 200, 40)};
  compare("solve_two_view", "essential matrix only", scenes.size(),
          over(scenes,
               [](const Scene& s) {
                 return solve_two_view(s.pairs, {.sigma_rad = 1e-3}).median_parallax_rad;
               }),
          over(scenes, [](const Scene& s) {
            return find_essential(s.pairs, {.sigma_rad = 1e-3, .max_samples = 300, .seed = 1})
                .criterion;
          }));
  compare("solve_absolute_pose", "refinement from the true pose", scenes.size(),
          over(scenes,
               [](const Scene& s) {
                 const auto found = solve_absolute_pose(s.points, s.second, 4e-3, 1);
                 return found ? found->camera_from_world.translation.x() : 0.0;
               }),
          over(scenes, [](const Scene& s) {
            std::vector<bool> right(s.points.size(), true);
            std::fill_n(right.begin(), 40, false);
            return refine_absolute_pose(s.motion, s.points, s.second, right).translation.x();
          }));
}

}  // namespace
}  // namespace lumibox::geometry

int main() {
  lumibox::geometry::Numbers numbers;
  lumibox::geometry::compare_groups(&numbers);
  lumibox::geometry::compare_unproject(&numbers);
  lumibox::geometry::compare_solvers(&numbers);
  lumibox::geometry::compare_precision(&numbers);
}
