#include "geometry/absolute_pose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/levenberg_marquardt.h"
#include "geometry/p3p.h"
#include "geometry/sampling.h"

namespace lumibox::geometry {
namespace {

constexpr int kMaxSamples = 400;
constexpr int kRefineIterations = 10;

struct Problem {
  std::span<const Eigen::Vector3d> points;
  std::span<const Eigen::Vector3d> bearings;
  double max_error2;
};

/// Squared sine of the angular error; infinite for points behind the camera.
double error2(const Pose& pose, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& point,
              const Eigen::Vector3d& bearing) {
  const Eigen::Vector3d in_camera = rotation * point + pose.translation;
  if (!(in_camera.dot(bearing) > 0.0)) return std::numeric_limits<double>::infinity();
  return in_camera.cross(bearing).squaredNorm() / in_camera.squaredNorm();
}

/// Sum of errors, each clipped at the bound (MSAC: Torr and Zisserman, "MLESAC", 2000). Gives up
/// once it exceeds `limit`.
double clipped_cost(const Problem& problem, const Pose& pose, double limit) {
  const Eigen::Matrix3d rotation = pose.matrix3();
  double sum = 0.0;
  for (std::size_t i = 0; i < problem.points.size() && sum < limit; ++i) {
    sum += std::min(error2(pose, rotation, problem.points[i], problem.bearings[i]),
                    problem.max_error2);
  }
  return sum;
}

int flag_inliers(const Problem& problem, const Pose& pose, std::vector<bool>* inliers) {
  const Eigen::Matrix3d rotation = pose.matrix3();
  int count = 0;
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    const bool inside =
        error2(pose, rotation, problem.points[i], problem.bearings[i]) < problem.max_error2;
    (*inliers)[i] = inside;
    count += inside ? 1 : 0;
  }
  return count;
}

/// A pose with its clipped cost and the points that agree with it.
struct Hypothesis {
  Pose pose;
  double cost;
  std::vector<bool> inliers;
  int inlier_count = 0;

  /// Takes over `candidate` if it costs less.
  bool improve(const Problem& problem, const Pose& candidate) {
    const double candidate_cost = clipped_cost(problem, candidate, cost);
    if (!(candidate_cost < cost)) return false;
    pose = candidate;
    cost = candidate_cost;
    inlier_count = flag_inliers(problem, pose, &inliers);
    return true;
  }
};

}  // namespace

Pose refine_absolute_pose(const Pose& start, std::span<const Eigen::Vector3d> points_in_world,
                          std::span<const Eigen::Vector3d> bearings, const std::vector<bool>& use) {
  if (std::count(use.begin(), use.end(), true) < 3) return start;
  const auto linearise = [&](const Pose& pose) {
    const Eigen::Matrix3d rotation = pose.matrix3();
    NormalEquations<6> sum;
    for (std::size_t i = 0; i < points_in_world.size(); ++i) {
      if (!use[i]) continue;
      const Eigen::Vector3d in_camera = rotation * points_in_world[i] + pose.translation;
      const double distance = in_camera.norm();
      if (!(distance > 0.0)) continue;
      const Eigen::Vector3d direction = in_camera / distance;
      const Eigen::Matrix<double, 2, 3> across = tangent_basis(bearings[i]).transpose();
      Eigen::Matrix<double, 3, 6> point_by_twist;
      point_by_twist << Eigen::Matrix3d::Identity(), -skew(in_camera);
      const Eigen::Matrix<double, 2, 3> error_by_point =
          (across - (across * direction) * direction.transpose()) / distance;
      sum.add<2>(across * direction, error_by_point * point_by_twist);
    }
    return sum;
  };
  const auto retract = [](const Pose& pose, const Vector6d& twist) {
    return exp_se3(twist) * pose;
  };
  return minimise<6>(start, linearise, retract, kRefineIterations);
}

std::optional<AbsolutePose> solve_absolute_pose(std::span<const Eigen::Vector3d> points_in_world,
                                                std::span<const Eigen::Vector3d> bearings,
                                                double max_error_rad, std::uint32_t seed) {
  const std::size_t count = points_in_world.size();
  if (count < 4 || bearings.size() != count) return std::nullopt;
  const double max_sine = std::sin(max_error_rad);
  const Problem problem{points_in_world, bearings, max_sine * max_sine};
  Hypothesis best{Pose(), problem.max_error2 * static_cast<double>(count),
                  std::vector<bool>(count, false)};
  Sampler sampler(seed);
  int needed = kMaxSamples;
  for (int i = 0; i < needed; ++i) {
    const auto [a, b, c] = sampler.draw<3>(count);
    bool improved = false;
    for (const Pose& pose : solve_p3p({points_in_world[a], points_in_world[b], points_in_world[c]},
                                      {bearings[a], bearings[b], bearings[c]})) {
      improved |= best.improve(problem, pose);
    }
    if (!improved) continue;
    best.improve(problem, refine_absolute_pose(best.pose, points_in_world, bearings, best.inliers));
    const double fraction = static_cast<double>(best.inlier_count) / static_cast<double>(count);
    needed = samples_needed(fraction, 3, kMaxSamples);
  }
  if (best.inlier_count < 4) return std::nullopt;
  best.improve(problem, refine_absolute_pose(best.pose, points_in_world, bearings, best.inliers));
  return AbsolutePose{best.pose, std::move(best.inliers), best.inlier_count};
}

}  // namespace lumibox::geometry
