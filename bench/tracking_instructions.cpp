// What scripts/instructions counts: the tracker on the first frames of a simulated sequence,
// without the mapper.
//
//     tracking_instructions film FILE      takes the pictures and keeps them; slow where it is
//     counted tracking_instructions track FILE     tracks them, and prints how many frames had a
//     map before

#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>

#include "bench/footage.h"
#include "config/error.h"
#include "hal/sim/random_scene.h"
#include "tracking/tracker.h"

namespace lumibox::bench {
namespace {

constexpr std::int64_t kFrames = 110;
constexpr std::int64_t kFrame_ns = 33'333'333;

hal::sim::SceneSpec scene() {
  return hal::sim::random_scene({1, hal::sim::Place::Desk, hal::sim::Walk::Arc, {}});
}

void film_into(const char* file) {
  const Footage footage = film_scene("instructions", hal::make_scene(scene()), kFrames);
  std::ofstream out(file, std::ios::binary);
  for (const Footage::Frame& frame : footage.frames) {
    out.write(reinterpret_cast<const char*>(frame.gray->data()),
              static_cast<std::streamsize>(frame.gray->size_bytes()));
  }
  out.close();
  if (!out) throw config::InputError(file, "cannot be written");
}

/// A function of its own and with a name that a tool can be told: what is counted.
extern "C" [[gnu::noinline]] void track_with_map(tracking::Tracker& tracker,
                                                 const hal::Image& picture, std::int64_t index) {
  tracker.track(picture, index, index * kFrame_ns);
}

void track_from(const char* file) {
  const geometry::Camera camera(scene().camera);
  hal::Image picture(camera.width(), camera.height(), 1);
  tracking::Tracker tracker(camera, config::Tracking(), tracking::Mapping::Lockstep, 0);
  std::ifstream in(file, std::ios::binary);
  int with_map = 0;
  for (std::int64_t i = 0; i < kFrames; ++i) {
    in.read(reinterpret_cast<char*>(picture.data()),
            static_cast<std::streamsize>(picture.size_bytes()));
    if (!in) throw config::InputError(file, "cannot be read; expected pictures of this program");
    if (tracker.statistics().keyframes == 0) {
      tracker.track(picture, i, i * kFrame_ns);
    } else {
      track_with_map(tracker, picture, i);
      ++with_map;
    }
  }
  std::printf("%d\n", with_map);
}

}  // namespace
}  // namespace lumibox::bench

int main(int argc, char** argv) {
  try {
    if (argc == 3 && std::strcmp(argv[1], "film") == 0) {
      lumibox::bench::film_into(argv[2]);
    } else if (argc == 3 && std::strcmp(argv[1], "track") == 0) {
      lumibox::bench::track_from(argv[2]);
    } else {
      std::fprintf(stderr, "usage: tracking_instructions film|track FILE\n");
      return 2;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tracking_instructions: %s\n", error.what());
    return 1;
  }
  return 0;
}
