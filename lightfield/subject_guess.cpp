#include "lightfield/subject_guess.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>

#include "geometry/robust.h"

namespace lumibox::lightfield {
namespace {

/// As Capture::sphere_radius_share: the sphere that the box itself places first.
constexpr double kRadiusShare = 0.35;

Eigen::Vector3d optical_axis(const Perspective& perspective) {
  return perspective.world_from_camera.rotation * Eigen::Vector3d::UnitZ();
}

/// Minimises the sum of squared distances to the axes: (sum of I - d d^T) x = sum of (I - d d^T) c.
/// None if the axes are too close to parallel to say where.
std::optional<Eigen::Vector3d> nearest_to_axes(const std::vector<Perspective>& perspectives) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Perspective& perspective : perspectives) {
    const Eigen::Vector3d d = optical_axis(perspective);
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - d * d.transpose();
    normal += across;
    right += across * perspective.center();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normal);
  // The smallest eigenvalue over n is about the mean squared sine between the axes and their mean:
  // below a third of a degree the depth is noise.
  constexpr double kLeastSpread = 3e-5;
  if (!(solver.eigenvalues()[0] > kLeastSpread * static_cast<double>(perspectives.size()))) {
    return std::nullopt;
  }
  const Eigen::Vector3d in_axes = solver.eigenvectors().transpose() * right;
  return Eigen::Vector3d(solver.eigenvectors() *
                         in_axes.cwiseQuotient(solver.eigenvalues()).eval());
}

bool in_front_of_most(const Eigen::Vector3d& point, const std::vector<Perspective>& perspectives) {
  const auto in_front = std::count_if(
      perspectives.begin(), perspectives.end(),
      [&](const Perspective& p) { return optical_axis(p).dot(point - p.center()) > 0.0; });
  return 2 * static_cast<std::size_t>(in_front) > perspectives.size();
}

Eigen::Vector3d before_the_middle(const std::vector<Perspective>& perspectives,
                                  const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (const Perspective& perspective : perspectives) {
    middle += perspective.center() / static_cast<double>(perspectives.size());
    direction += optical_axis(perspective);
  }
  // Axes that cancel out, as of a camera turning on the spot, leave any one as good as another.
  direction = direction.norm() > 1e-6 ? direction.normalized() : optical_axis(perspectives.front());
  std::vector<double> depths;
  for (const Eigen::Vector3d& point : points) {
    const double depth = direction.dot(point - middle);
    if (depth > 0.0) depths.push_back(depth);
  }
  if (!depths.empty()) return middle + geometry::median(std::move(depths)) * direction;
  double spread = 0.0;
  for (const Perspective& perspective : perspectives) {
    spread = std::max(spread, (perspective.center() - middle).norm());
  }
  return middle + (spread > 0.0 ? 3.0 * spread : 1.0) * direction;
}

}  // namespace

Sphere guess_subject(const std::vector<Perspective>& perspectives,
                     const std::vector<Eigen::Vector3d>& points) {
  std::optional<Eigen::Vector3d> center = nearest_to_axes(perspectives);
  if (!center || !in_front_of_most(*center, perspectives)) {
    center = before_the_middle(perspectives, points);
  }
  std::vector<double> distances;
  for (const Perspective& perspective : perspectives) {
    distances.push_back((perspective.center() - *center).norm());
  }
  const double distance = geometry::median(std::move(distances));
  return {*center, distance > 0.0 ? kRadiusShare * distance : 1.0};
}

}  // namespace lumibox::lightfield
