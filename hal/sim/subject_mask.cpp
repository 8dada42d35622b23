#include <embree3/rtcore.h>

#include <limits>
#include <mutex>

#include "hal/sim/scene.h"
#include "hal/sim/scene_impl.h"
#include "hal/sim/world.h"

namespace lumibox::hal {
namespace {

/// Whether the first surface along a ray lies within the sphere.
bool meets_subject(const sim::World& world, const Scene::Subject& subject,
                   const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  alignas(16) RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(origin.x());
  ray.ray.org_y = static_cast<float>(origin.y());
  ray.ray.org_z = static_cast<float>(origin.z());
  ray.ray.dir_x = static_cast<float>(direction.x());
  ray.ray.dir_y = static_cast<float>(direction.y());
  ray.ray.dir_z = static_cast<float>(direction.z());
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  world.intersect1(ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  const Eigen::Vector3d hit = origin + static_cast<double>(ray.ray.tfar) * direction;
  return (hit - subject.center).norm() < subject.radius;
}

}  // namespace

Image Scene::subject_mask(const geometry::Camera& camera, const geometry::Pose& world_from_camera,
                          double time_s) const {
  sim::World& world = *impl_->world;
  std::unique_lock<std::mutex> alone(world.mutex(), std::defer_lock);
  if (world.moves()) {
    alone.lock();
    world.move_to(time_s);
  }
  Image mask(camera.width(), camera.height(), 1);
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      const auto bearing = camera.unproject(Eigen::Vector2d(x, y));
      if (!bearing) continue;
      const Eigen::Vector3d direction = world_from_camera.rotation * bearing->homogeneous();
      const bool seen = meets_subject(world, subject(), world_from_camera.translation, direction);
      *mask.at(x, y) = seen ? 255 : 0;
    }
  }
  return mask;
}

}  // namespace lumibox::hal
