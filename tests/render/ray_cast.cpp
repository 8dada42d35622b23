#include "render/ray_cast.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "support/photo.h"
namespace lumibox::test {
namespace {

/// Smooth in all three coordinates, so that bilinear sampling reproduces it well.
Eigen::Vector3d pattern(const Eigen::Vector3d& p) {
  return {0.5 + 0.25 * std::sin(7.0 * p.x() + 1.0) + 0.2 * std::sin(5.0 * p.y()),
          0.5 + 0.25 * std::sin(6.0 * p.y() + 2.0) + 0.2 * std::sin(9.0 * p.z() + p.x()),
          0.5 + 0.25 * std::sin(4.0 * (p.x() - p.y())) + 0.2 * std::sin(8.0 * p.z())};
}

/// Distance along the ray to the sphere around the origin: to the near side, or from inside to the
/// far one.
std::optional<double> hit_sphere(const Ray& ray, double radius) {
  const Eigen::Vector3d d = ray.direction.normalized();
  const double b = ray.origin.dot(d);
  const double root2 = b * b - ray.origin.squaredNorm() + radius * radius;
  if (root2 < 0.0) return std::nullopt;
  const double near = -b - std::sqrt(root2);
  const double far = -b + std::sqrt(root2);
  if (far <= 0.0) return std::nullopt;
  return near > 0.0 ? near : far;
}

}  // namespace

World textured_plane(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  return [point, normal](const Ray& ray) -> Eigen::Vector3d {
    const double t = normal.dot(point - ray.origin) / normal.dot(ray.direction);
    if (!(t > 0.0) || !std::isfinite(t)) return Eigen::Vector3d::Zero();
    return pattern(ray.origin + t * ray.direction);
  };
}

World textured_ball(double radius) {
  return [radius](const Ray& ray) -> Eigen::Vector3d {
    const Eigen::Vector3d d = ray.direction.normalized();
    if (const auto t = hit_sphere(ray, radius)) return pattern(ray.origin + *t * d);
    const double shell = 10.0 * radius;
    if (const auto t = hit_sphere(ray, shell)) return pattern((ray.origin + *t * d) / 2.0);
    return Eigen::Vector3d::Zero();
  };
}

hal::Image photograph(const World& world, const geometry::Camera& camera,
                      const geometry::Pose& world_from_camera) {
  hal::Image image(camera.width(), camera.height(), 3);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const auto normalised = camera.unproject(Eigen::Vector2d(x, y));
      if (!normalised) continue;
      const Eigen::Vector3d direction = world_from_camera.rotation * normalised->homogeneous();
      const Eigen::Vector3d color = world({world_from_camera.translation, direction});
      for (int c = 0; c < 3; ++c) {
        const double value = std::clamp(color[c], 0.0, 1.0);
        image.at(x, y)[c] = static_cast<std::uint8_t>(std::lround(255.0 * value));
      }
    }
  }
  return image;
}

geometry::Pose look_at(const Eigen::Vector3d& center, const Eigen::Vector3d& target, double roll) {
  const Eigen::Vector3d forward = (target - center).normalized();
  Eigen::Vector3d right = Eigen::Vector3d::UnitY().cross(forward);
  if (right.norm() < 1e-6) right = Eigen::Vector3d::UnitX();
  right.normalize();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  const Eigen::AngleAxisd about_axis(roll, Eigen::Vector3d::UnitZ());
  return {Eigen::Matrix3d(axes * about_axis.toRotationMatrix()), center};
}

geometry::Camera make_camera(int width, int height, bool distorted) {
  config::CameraProfile p;
  p.width = width;
  p.height = height;
  p.fx = p.fy = 0.5 * width / std::tan(std::numbers::pi / 6.0);
  p.cx = 0.5 * (width - 1);
  p.cy = 0.5 * (height - 1);
  if (distorted) {
    p.k1 = -0.28;
    p.k2 = 0.07;
    p.p1 = 0.001;
    p.p2 = -0.0015;
    p.k3 = 0.004;
  }
  return geometry::Camera(p);
}

geometry::Camera make_fisheye_camera(int width, int height) {
  config::CameraProfile p = make_camera(width, height).profile();
  p.model = config::LensModel::Fisheye;
  p.fx = p.fy = 0.5 * width / (std::numbers::pi / 3.0);
  p.k1 = -0.03;
  p.k2 = 0.01;
  p.k3 = -0.02;
  p.k4 = 0.008;
  return geometry::Camera(p);
}

lightfield::Perspective photograph_perspective(int id, const World& world,
                                               const geometry::Camera& camera,
                                               const geometry::Pose& world_from_camera) {
  lightfield::Perspective perspective;
  perspective.id = id;
  perspective.world_from_camera = world_from_camera;
  perspective.photo = testing::photo_of(photograph(world, camera, world_from_camera));
  perspective.camera = std::make_shared<const geometry::Camera>(camera);
  return perspective;
}

std::vector<lightfield::Perspective> random_capture(const World& world,
                                                    const geometry::Camera& camera, int count,
                                                    double distance, double spread,
                                                    std::uint32_t seed) {
  std::mt19937 generator(seed);
  // Not std::uniform_real_distribution: its values differ between standard libraries.
  const auto uniform = [&generator](double low, double high) {
    return low + (high - low) * (static_cast<double>(generator()) / 4294967296.0);
  };
  std::vector<lightfield::Perspective> perspectives;
  for (int i = 0; i < count; ++i) {
    const double across = uniform(-spread, spread);
    const double up = uniform(-spread, spread);
    const double range = distance * uniform(0.9, 1.1);
    const Eigen::Vector3d center(range * std::sin(across) * std::cos(up), range * std::sin(up),
                                 -range * std::cos(across) * std::cos(up));
    const Eigen::Vector3d target(uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(-0.1, 0.1));
    const geometry::Pose pose = look_at(center, target, uniform(-0.3, 0.3));
    perspectives.push_back(photograph_perspective(i, world, camera, pose));
  }
  return perspectives;
}

}  // namespace lumibox::test
