#include "hal/sim/frame_renderer.h"

#include <mutex>

#include "hal/sim/random.h"

namespace lumibox::hal::sim {

FrameRenderer::FrameRenderer(const Scene& scene)
    : scene_(scene),
      tracer_(*scene.impl().world, scene.impl().spec, geometry::Camera(scene.profile())),
      shutter_(make_shutter({*scene.impl().world, scene.impl().path, tracer_},
                            scene.impl().spec.effects)),
      stages_(make_stages(scene.impl().spec)),
      light_(scene.profile().width, scene.profile().height) {}

Image FrameRenderer::render(std::int64_t frame, bool exposure_locked, SimCost& cost) {
  const Scene::Impl& scene = scene_.impl();
  const Tracer::RayCount before = tracer_.rays();
  cost = {};
  Exposure exposure;
  exposure.frame = frame;
  exposure.time_s = static_cast<double>(frame) / scene.spec.camera.fps;
  exposure.locked = exposure_locked;
  {
    std::unique_lock<std::mutex> alone(scene.world->mutex(), std::defer_lock);
    if (scene.world->moves()) alone.lock();
    shutter_->expose(exposure.time_s, light_, cost);
  }
  for (const auto& stage : stages_) {
    stage->apply(light_, exposure);
    cost.stages.push_back(stage->name());
  }
  cost.stages.emplace_back("tone_mapping");
  cost.camera_rays = tracer_.rays().camera - before.camera;
  cost.secondary_rays = tracer_.rays().secondary - before.secondary;
  return tone_mapped(light_, scene.spec.exposure);
}

bool is_dropped(const EffectSpecs& effects, std::int64_t frame) {
  if (!effects.dropped_frames) return false;
  const DroppedFramesSpec& spec = *effects.dropped_frames;
  // A gap that began at one of the frames before may still last.
  for (std::int64_t begin = std::max<std::int64_t>(0, frame - spec.burst + 1); begin <= frame;
       ++begin) {
    Random random(spec.seed ^ scramble(static_cast<std::uint64_t>(begin)));
    const bool begins = random.uniform() < spec.share;
    if (begins && frame - begin < 1 + random.below(spec.burst)) return true;
  }
  return false;
}

}  // namespace lumibox::hal::sim
