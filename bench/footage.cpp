#include "bench/footage.h"

#include "hal/sim/sim_camera.h"
#include "hal/sim/virtual_clock.h"
#include "tracking/pyramid.h"

namespace lumibox::bench {

Footage film(const std::string& name, hal::Camera& camera, hal::Clock& clock, std::int64_t count) {
  Footage footage{name, geometry::Camera(camera.profile()), {}, {}};
  const double period_ns = 1e9 / camera.profile().fps;
  const std::int64_t start_ns = clock.now_ns();
  for (std::int64_t tick = 0; tick < count && camera.state() != hal::CameraState::Ended; ++tick) {
    // Half a period late, so that a frame's delay by the shutter does not hide it.
    const double at = static_cast<double>(tick) + 0.5;
    clock.wait_until(start_ns + static_cast<std::int64_t>(at * period_ns));
    if (const auto frame = camera.take_newest()) {
      footage.frames.push_back({frame->timestamp_ns, frame->gray});
    }
  }
  return footage;
}

Footage film_scene(const std::string& name, const std::shared_ptr<const hal::Scene>& scene,
                   std::int64_t count) {
  hal::VirtualClock clock;
  hal::SimCamera camera(scene, clock);
  camera.start();
  Footage footage = film(name, camera, clock, count);
  for (const Footage::Frame& frame : footage.frames) {
    const double time_s = 1e-9 * static_cast<double>(frame.timestamp_ns);
    footage.truth.push_back({time_s, scene->world_from_camera(time_s)});
  }
  return footage;
}

Footage halved(const Footage& footage) {
  Footage result{footage.name, footage.camera.at_level(1), {}, footage.truth};
  for (const Footage::Frame& frame : footage.frames) {
    result.frames.push_back({frame.timestamp_ns, std::make_shared<const hal::Image>(
                                                     tracking::Pyramid(*frame.gray, 2).level(1))});
  }
  return result;
}

}  // namespace lumibox::bench
