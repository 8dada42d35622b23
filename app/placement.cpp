#include "app/placement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/rotation.h"

namespace lumibox::app {
namespace {

// Enough for the median to pass over a few points of the background or of an occluder; few enough
// that they lie on the thing in the reticle and not on the table around it.
constexpr std::size_t kPointsWanted = 15;
constexpr std::size_t kPointsNeeded = 3;

struct Candidate {
  double angle = 0.0;
  double depth = 0.0;
};

}  // namespace

Eigen::Vector2d reticle(const geometry::Camera& camera) {
  return {0.5 * (camera.width() - 1), 0.5 * (camera.height() - 1)};
}

std::optional<Ray> ray_of_pixel(const geometry::Camera& camera,
                                const geometry::Pose& world_from_camera,
                                const Eigen::Vector2d& pixel) {
  const std::optional<Eigen::Vector2d> normalised = camera.unproject(pixel);
  if (!normalised) {
    return std::nullopt;
  }
  const Eigen::Vector3d direction_in_camera = normalised->homogeneous().normalized();
  return Ray{world_from_camera.translation, world_from_camera.rotation * direction_in_camera};
}

std::optional<double> depth_on_ray(const Ray& ray, const std::vector<Eigen::Vector3d>& points) {
  std::vector<Candidate> candidates;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d from_origin = point - ray.origin;
    const double depth = from_origin.dot(ray.direction);
    if (depth > 0.0) {
      candidates.push_back({geometry::angle_between(from_origin, ray.direction), depth});
    }
  }
  if (candidates.size() < kPointsNeeded) {
    return std::nullopt;
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::angle);
  candidates.resize(std::min(candidates.size(), kPointsWanted));
  std::ranges::stable_sort(candidates, {}, &Candidate::depth);
  return candidates[candidates.size() / 2].depth;
}

double slide_depth(double depth, int steps, double depth_step) {
  return depth * std::pow(1.0 + depth_step, steps);
}

lightfield::Sphere sphere_on_ray(const Ray& ray, double depth, const config::Capture& options) {
  return {ray.origin + depth * ray.direction, depth * options.sphere_radius_share};
}

}  // namespace lumibox::app
