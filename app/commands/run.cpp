#include <csignal>
#include <cstdio>

#include "app/attempts.h"
#include "app/commands/commands.h"
#include "app/commands/support.h"
#include "app/last_good.h"
#include "app/loop.h"
#include "app/metronome.h"
#include "app/service.h"
#include "app/waiting.h"

namespace lumibox::app {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

void ask_to_stop(int) {
  stop_asked = 1;
}

void print(const Loop& loop) {
  const LoopStatistics statistics = loop.statistics();
  std::printf("%lld ticks, %lld late; %lld frames, %lld tracked; %zu perspectives\n",
              static_cast<long long>(statistics.ticks),
              static_cast<long long>(statistics.late_ticks),
              static_cast<long long>(statistics.frames), static_cast<long long>(statistics.tracked),
              loop.recorder().light_field().perspectives().size());
}

constexpr const char* kOnLastGood = "on the last good settings: ";

/// For the service manager, which has one line: what the screen says at the top, and what is wrong.
std::string status_of(const Picture& picture) {
  std::string status = picture.title;
  for (const std::string& alert : picture.alerts) status += "; " + alert;
  return status;
}

/// Whether the box is to end before its recording does.
bool is_to_end(const Devices& devices) {
  return stop_asked != 0 || (devices.display && devices.display->closed());
}

/// What happens between two ticks: the service manager is told how the box is, and settings with
/// which pictures came on the screen are kept.
class Caretaker {
 public:
  Caretaker(const RunOptions& options, const OpenBox& box, const Loop& loop, Service& service)
      : options_(options), box_(box), loop_(loop), service_(service) {
    keeps_settings_ = options.last_good && options.sources.file && !box.problem;
  }

  /// False if the box is to end.
  bool go_on() {
    const std::int64_t presented = box_.devices.display->presented();
    service_.tick(box_.devices.clock->now_ns(), presented, status_of(loop_.picture()));
    if (keeps_settings_ && presented > 0) {
      keep_last_good(box_.settings, *options_.last_good);
      keeps_settings_ = false;
    }
    return !is_to_end(box_.devices) && box_.devices.camera->state() != hal::CameraState::Ended;
  }

 private:
  const RunOptions& options_;
  const OpenBox& box_;
  const Loop& loop_;
  Service& service_;
  bool keeps_settings_;
};

/// Until the box has its screen and its camera; false if it is to end before.
bool wait_for_devices(OpenBox& box, Service& service) {
  Waiting waiting(box.devices, box.config);
  if (box.problem) waiting.always_show(kOnLastGood + *box.problem);
  hal::Clock& clock = *box.devices.clock;
  Metronome metronome(clock, box.config.loop.rate_hz);
  while (!waiting.over() && !is_to_end(box.devices)) {
    waiting.tick();
    service.tick(clock.now_ns(), waiting.presented(), status_of(waiting.picture()));
    metronome.wait();
  }
  return waiting.over();
}

}  // namespace

void run(const RunOptions& options) {
  // Before the devices are opened: the screen is given back only by who ends as it should.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, ask_to_stop);
  if (options.last_good) check_last_good(*options.last_good);
  OpenBox box = open_box(options.sources, options.last_good);
  Service service;
  if (!wait_for_devices(box, service)) return service.stopping();
  const geometry::Camera camera(box.devices.camera->profile());
  Loop loop(
      box.devices, box.config, box.config.capture.folder,
      box.devices.lockstep ? kLockstep : kThreaded,
      find_saved_capture(box.config.capture.folder, camera, box.config.tracking.pyramid_levels));
  if (box.problem) loop.always_show(kOnLastGood + *box.problem);
  Caretaker caretaker(options, box, loop, service);
  Attempts attempts;  // what the run came to is said whatever went wrong
  attempts.attempt(
      [&] { loop.run_and_finish([&] { return caretaker.go_on(); }, [&] { service.stopping(); }); });
  print(loop);
  attempts.rethrow();
}

}  // namespace lumibox::app
