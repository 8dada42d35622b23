#pragma once

#include <memory>
#include <string>

#include "hal/sim/scene.h"
#include "hal/sim/sim_camera.h"
#include "hal/sim/virtual_clock.h"
#include "support/temp_dir.h"

namespace lumibox::hal::testing {

/// A scene of `text`; relative files in it do not exist.
inline std::shared_ptr<const Scene> scene_of(const std::string& text) {
  const lumibox::testing::TempDir folder;
  return load_scene(folder.write("scene.toml", text));
}

/// A camera at the origin that looks along y at a small white ball in the dark; `extra` is
/// appended.
inline std::string ball_scene(double x, double y, double z, const std::string& extra = "") {
  return R"(
duration_s = 1.0
background = [0.0, 0.0, 0.0]
subject = { center = [0.0, 2.0, 0.0], radius_m = 0.5 }
camera = { width = 640, height = 480, fx = 540.0 }
lights = [{ kind = "ambient" }]
path = { keys = [{ time_s = 0.0, at = [0.0, 0.0, 0.0], target = [0.0, 1.0, 0.0] }] }
[[objects]]
name = "ball"
shape = "sphere"
size = [0.1, 0.1, 0.1]
segments = 64
at = [)" +
         std::to_string(x) + ", " + std::to_string(y) + ", " + std::to_string(z) + "]\n" + extra;
}

/// A camera that strafes past a patterned wall; `extra` is appended.
inline std::string wall_scene(const std::string& extra = "", const std::string& last_at = "0.4") {
  return R"(
duration_s = 1.0
subject = { center = [0.0, 1.0, 0.0], radius_m = 0.5 }
camera = { width = 160, height = 120, fx = 140.0, fps = 20.0 }
lights = [{ kind = "ambient" }]
[path]
keys = [
  { time_s = 0.0, at = [0.0, 0.0, 0.0], target = [0.0, 1.0, 0.0] },
  { time_s = 1.0, at = [)" +
         last_at + R"(, 0.0, 0.0], target = [0.0, 1.0, 0.0] },
]
[[textures]]
name = "wall"
pattern = "poster"
texels = [128, 128]
cell_m = 0.3
palette = [[0.8, 0.8, 0.7], [0.2, 0.3, 0.6], [0.7, 0.2, 0.2]]
[[objects]]
name = "wall"
shape = "quad"
size = [6.0, 6.0, 0.0]
segments = 4
at = [0.0, 1.0, 0.0]
turn_deg = [0.0, 90.0, 0.0]
texture = "wall"
)" + extra;
}

/// Picture number `index` of a fresh camera that nobody asked for the ones before.
inline Image frame_alone(const std::shared_ptr<const Scene>& scene, std::int64_t index,
                         SimCost* cost = nullptr) {
  VirtualClock clock;
  SimCamera camera(scene, clock);
  camera.start();
  // Exposure and readout end after the timestamp, at most one period later.
  clock.wait_until(scene->timestamp_ns(index) + scene->timestamp_ns(1) - 1);
  const std::optional<Frame> frame = camera.take_newest();
  if (cost != nullptr) *cost = camera.last_cost();
  return frame && frame->index == index ? *frame->color : Image();
}

}  // namespace lumibox::hal::testing
