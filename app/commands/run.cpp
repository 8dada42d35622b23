#include <csignal>
#include <cstdio>

#include "app/attempts.h"
#include "app/commands/commands.h"
#include "app/commands/support.h"
#include "app/loop.h"

namespace lumibox::app {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

void ask_to_stop(int) {
  stop_asked = 1;
}

}  // namespace

void run(const RunOptions& options) {
  const config::Config config = load_config(options.sources);
  Devices devices = open_devices(config);
  make_folder(config.capture.folder);
  const geometry::Camera camera(devices.camera->profile());
  Loop loop(devices, config, config.capture.folder, devices.lockstep ? kLockstep : kThreaded,
            find_saved_capture(config.capture.folder, camera, config.tracking.pyramid_levels));
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
  Attempts attempts;  // what the run came to is said whatever went wrong
  attempts.attempt([&] {
    loop.run_and_finish(
        [&] { return stop_asked == 0 && devices.camera->state() != hal::CameraState::Ended; });
  });
  const LoopStatistics statistics = loop.statistics();
  std::printf("%lld ticks, %lld late; %lld frames, %lld tracked; %zu perspectives\n",
              static_cast<long long>(statistics.ticks),
              static_cast<long long>(statistics.late_ticks),
              static_cast<long long>(statistics.frames), static_cast<long long>(statistics.tracked),
              loop.recorder().light_field().perspectives().size());
  attempts.rethrow();
}

}  // namespace lumibox::app
