#include "bench/sim_frame.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "bench/stopwatch.h"
#include "geometry/robust.h"
#include "hal/sim/sim_camera.h"
#include "hal/sim/virtual_clock.h"

namespace lumibox::bench {

nlohmann::json measure_sim_frame(const std::shared_ptr<const hal::Scene>& scene,
                                 const std::string& name, std::int64_t wanted_frames) {
  // Spread over the whole walk: what is in view differs.
  const std::int64_t frames = std::min(wanted_frames, scene->frame_count());
  hal::VirtualClock clock;
  hal::SimCamera camera(scene, clock);
  camera.start();
  std::vector<double> frame_ms;
  hal::SimCost cost;
  for (std::int64_t i = 0; i < frames; ++i) {
    // Half a period late, so that a frame's delay by the shutter does not hide it.
    const double at = static_cast<double>(i * scene->frame_count() / frames) + 0.5;
    clock.wait_until(static_cast<std::int64_t>(1e9 * at / scene->profile().fps));
    const double before_ms = program_cpu_ms();
    if (!camera.take_newest()) continue;  // lost on its way by an effect
    frame_ms.push_back(program_cpu_ms() - before_ms);
    cost = camera.last_cost();
  }
  return {{"what", "sim_frame"},
          {"scene", name},
          {"frames", frame_ms.size()},
          {"cpu_ms",
           {{"median", geometry::quantile(frame_ms, 0.5)},
            {"p95", geometry::quantile(frame_ms, 0.95)}}},
          {"camera_rays", cost.camera_rays},
          {"secondary_rays", cost.secondary_rays}};
}

}  // namespace lumibox::bench
