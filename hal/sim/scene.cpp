#include "hal/sim/scene.h"

#include <cmath>
#include <mutex>

#include "hal/sim/image_stages.h"
#include "hal/sim/scene_file.h"
#include "hal/sim/scene_impl.h"
#include "hal/sim/tracer.h"

namespace lumibox::hal {

Scene::Scene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Scene::~Scene() = default;

const config::CameraProfile& Scene::profile() const {
  return impl_->spec.camera;
}

std::int64_t Scene::frame_count() const {
  const double frames = impl_->spec.duration_s * impl_->spec.camera.fps;
  return std::max<std::int64_t>(1, std::llround(frames));
}

std::int64_t Scene::timestamp_ns(std::int64_t frame) const {
  return std::llround(static_cast<double>(frame) * 1e9 / impl_->spec.camera.fps);
}

geometry::Pose Scene::world_from_camera(double time_s) const {
  return impl_->path.world_from_camera(time_s);
}

Scene::Subject Scene::subject() const {
  return {impl_->spec.subject_center, impl_->spec.subject_radius_m};
}

Image Scene::render_ideal(const geometry::Camera& camera, const geometry::Pose& world_from_camera,
                          double time_s) const {
  sim::World& world = *impl_->world;
  sim::Tracer tracer(world, impl_->spec, camera);
  sim::LinearImage image(camera.width(), camera.height());
  std::unique_lock<std::mutex> alone(world.mutex(), std::defer_lock);
  if (world.moves()) {
    alone.lock();
    world.move_to(time_s);
  }
  tracer.trace_rows(world_from_camera, 0, image.height, image);
  return sim::tone_mapped(image, impl_->spec.exposure);
}

std::shared_ptr<const Scene> load_scene(const std::filesystem::path& file) {
  return make_scene(sim::read_scene_file(file));
}

std::shared_ptr<const Scene> make_scene(const sim::SceneSpec& spec) {
  return std::make_shared<const Scene>(std::make_unique<Scene::Impl>(spec));
}

}  // namespace lumibox::hal
