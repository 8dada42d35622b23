#include "hal/live/live_camera.h"

#include <poll.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

#include "config/error.h"
#include "config/log.h"

namespace lumibox::hal {

LiveCamera::LiveCamera(live::Prepared prepared, const Clock& clock, Service service)
    : clock_(clock),
      service_(service),
      device_(std::move(prepared.device)),
      profile_(std::move(prepared.profile)),
      introduction_(std::move(prepared.introduction)),
      streamer_(*device_, slot_, prepared.settings) {}

LiveCamera::~LiveCamera() {
  LiveCamera::stop();
}

void LiveCamera::start() {
  stop();
  if (const auto fault = streamer_.start(clock_.now_ns())) {
    throw config::Unavailable("devices.camera: " + *fault);
  }
  introduce();
  if (service_ == Service::Thread) thread_ = std::thread([this] { run(); });
}

void LiveCamera::stop() {
  if (thread_.joinable()) {
    stopping_ = true;
    wake_up_.ring();
    thread_.join();
    stopping_ = false;
  }
  streamer_.stop();
}

std::optional<Frame> LiveCamera::take_newest() {
  if (service_ == Service::Caller) streamer_.service(clock_.now_ns());
  return slot_.take();
}

/// Setting a control takes a camera some milliseconds: not for the loop to wait for.
void LiveCamera::lock_exposure(bool locked) {
  streamer_.hold_exposure(locked);
  wake_up_.ring();
}

/// Once, and not before it streams: one that another program has may be tried for hours.
void LiveCamera::introduce() {
  if (!introduction_) return;
  config::log_info(introduction_->info);
  for (const std::string& warning : introduction_->warnings) config::log_warning(warning);
  introduction_.reset();
}

void LiveCamera::run() {
  while (!stopping_) {
    wait();
    streamer_.service(clock_.now_ns());
    slot_.decode_ahead();
  }
}

/// For the camera, a change of the devices, a wish of the loop's, or the time to do something.
void LiveCamera::wait() {
  pollfd events[] = {{streamer_.poll_fd(), POLLIN, 0},
                     {device_->watch_fd(), POLLIN, 0},
                     {wake_up_.fd(), POLLIN, 0}};  // poll() leaves out what is -1
  poll(events, std::size(events), milliseconds_until(streamer_.due_ns()));
  wake_up_.clear();
}

int LiveCamera::milliseconds_until(std::int64_t due_ns) const {
  constexpr std::int64_t kLongestMs = 60'000;
  const std::int64_t now_ns = clock_.now_ns();
  if (due_ns <= now_ns) return 0;
  return static_cast<int>(std::min(kLongestMs, (due_ns - now_ns) / 1'000'000 + 1));
}

}  // namespace lumibox::hal
