// What a frame of each shipped scene costs the simulated camera:
//   sim_frame_bench [FRAMES] [SCENE...]

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/robust.h"
#include "hal/sim/scene.h"
#include "hal/sim/sim_camera.h"
#include "hal/sim/virtual_clock.h"

namespace lumibox {
namespace {

const std::vector<std::string> kShippedScenes{"toy",          "statue_orbit", "facade",
                                              "crystal_ball", "person",       "night_webcam"};

/// Processor time of this process, all threads: other programs do not disturb it.
double cpu_ms() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

nlohmann::json measure(const std::string& name, std::int64_t wanted_frames) {
  const double begin_ms = cpu_ms();
  const auto scene = hal::load_scene(std::filesystem::path(LUMIBOX_SOURCE_DIR) / "hal/sim/scenes" /
                                     (name + ".toml"));
  const double load_ms = cpu_ms() - begin_ms;

  // Spread over the whole walk: what is in view differs.
  const std::int64_t frames = std::min(wanted_frames, scene->frame_count());
  hal::VirtualClock clock;
  hal::SimCamera camera(scene, clock);
  camera.start();
  std::vector<double> frame_ms;
  hal::SimCost cost;
  for (std::int64_t i = 0; i < frames; ++i) {
    // Half a period late, so that a frame's delay by the shutter does not hide it.
    const double at_s = (static_cast<double>(i * scene->frame_count() / frames) + 0.5);
    clock.wait_until(static_cast<std::int64_t>(1e9 * at_s / scene->profile().fps));
    const double before_ms = cpu_ms();
    if (!camera.take_newest()) continue;  // lost on its way by an effect
    frame_ms.push_back(cpu_ms() - before_ms);
    cost = camera.last_cost();
  }
  return {{"what", "sim_frame"},
          {"scene", name},
          {"frames", frame_ms.size()},
          {"load_ms", load_ms},
          {"ms_median", geometry::median(frame_ms)},
          {"camera_rays", cost.camera_rays},
          {"secondary_rays", cost.secondary_rays}};
}

int run(const std::vector<std::string>& arguments) {
  std::int64_t frames = 30;
  if (!arguments.empty()) {
    const std::string& text = arguments.front();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), frames);
    if (error != std::errc() || end != text.data() + text.size() || frames < 1) {
      std::fprintf(stderr, "usage: sim_frame_bench [FRAMES] [SCENE...]; FRAMES is at least 1\n");
      return 2;
    }
  }
  const std::vector<std::string> named(arguments.begin() + (arguments.empty() ? 0 : 1),
                                       arguments.end());
  for (const std::string& name : named.empty() ? kShippedScenes : named) {
    std::puts(measure(name, frames).dump().c_str());
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace lumibox

int main(int argc, char** argv) {
  try {
    return lumibox::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sim_frame_bench: %s\n", error.what());
    return 1;
  }
}
