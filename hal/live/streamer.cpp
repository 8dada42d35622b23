#include "hal/live/streamer.h"

#include <fmt/core.h>

#include <string>
#include <utility>

#include "config/log.h"

namespace lumibox::hal::live {
namespace {

/// Pictures, many times what a stream's buffers hold: a camera that fills them faster than they are
/// emptied must not hold us up.
constexpr int kMostAtOnce = 64;

}  // namespace

Streamer::Streamer(Device& device, FrameSlot& slot, const StreamSettings& settings)
    : device_(device),
      slot_(slot),
      settings_(settings),
      recovery_(settings.patience_ns),
      stamping_(settings.readout_ns) {}

std::optional<std::string> Streamer::start(std::int64_t now_ns) {
  stop();
  numbering_ = Numbering();
  stamping_ = Stamping(settings_.readout_ns);
  said_damage_ = said_stamps_ = false;
  // It may have been lost, or plugged in anew, since it was opened.
  if (!device_.is_open() || begin_stream()) {
    if (auto fault = open_and_begin(now_ns)) {
      close_device(now_ns);
      recovery_.stopped();
      return fault;
    }
  }
  recovery_.began(now_ns);
  state_ = CameraState::Streaming;
  return std::nullopt;
}

void Streamer::stop() {
  // A camera keeps what was set in it, and whoever has it next would take that for its own.
  device_.forget_hold();
  newest_.reset();
  device_.end();
  recovery_.stopped();
  slot_.clear();
  state_ = CameraState::Stopped;
}

void Streamer::service(std::int64_t now_ns) {
  if (state_ == CameraState::Stopped) return;
  if (device_.changed()) recovery_.device_appeared(now_ns);
  if (device_.is_streaming()) drain(now_ns);
  recover(now_ns);
  if (device_.is_streaming()) device_.update_hold(hold_wanted_);
}

/// Opens the device anew; the reason if there is none, or none that streams.
std::optional<std::string> Streamer::open_and_begin(std::int64_t now_ns) {
  device_.close();  // a camera may be opened only once
  if (auto fault = device_.open()) return fault;
  if (const auto fault = begin_stream()) return device_.name() + ": " + *fault;
  recovery_.began(now_ns);
  return std::nullopt;
}

std::optional<std::string> Streamer::begin_stream() {
  numbering_.begin_stream();
  return device_.begin();
}

void Streamer::drain(std::int64_t now_ns) {
  for (int i = 0; i < kMostAtOnce; ++i) {
    const Device::Taken taken = device_.take();
    if (const auto* fault = std::get_if<std::string>(&taken)) return lose(*fault, now_ns);
    const auto* filled = std::get_if<Filled>(&taken);
    if (filled == nullptr) break;
    if (accept(*filled, now_ns)) continue;
    if (const auto refused = device_.give_back(*filled)) return lose(*refused, now_ns);
  }
  if (newest_) return hand_over(now_ns);
  if (const auto loss = device_.loss()) lose(*loss, now_ns);
}

/// Whether the buffer is kept, as the newest so far; the one before goes back to the camera.
bool Streamer::accept(const Filled& filled, std::int64_t now_ns) {
  const std::int64_t index = numbering_.next(filled.sequence);
  const Damage damage = damage_of(filled, device_.layout());
  slot_.count_dropped(numbering_.missed() + (damage != Damage::None ? 1 : 0));
  if (damage != Damage::None) {
    if (!std::exchange(said_damage_, true)) {
      config::log_warning(fmt::format("{}: a damaged picture is left out, as others will be: {}",
                                      name(), to_string(damage)));
    }
    return false;
  }
  const std::int64_t timestamp_ns = stamping_.stamp(filled, now_ns);
  if (stamping_.replaced() && !std::exchange(said_stamps_, true)) {
    config::log_warning(name() + ": its times cannot be used; pictures get the time they come at");
  }
  const std::optional<Newest> older = std::exchange(newest_, Newest{filled, index, timestamp_ns});
  if (older) {
    slot_.count_dropped(1);
    device_.give_back(older->filled);  // an error shows again at the next buffer
  }
  return true;
}

/// The copy lets the camera have its buffer back at once, and outlives the device. Undecoded it is
/// quick: nothing of what is displaced later has cost more.
void Streamer::hand_over(std::int64_t now_ns) {
  const Newest newest = *std::exchange(newest_, std::nullopt);
  slot_.put({device_.layout(), copy_of(newest.filled), newest.index, newest.timestamp_ns});
  recovery_.got_frame(now_ns);
  if (state_ == CameraState::Lost) {
    config::log_info(fmt::format("{}: is back after {:.1f} s", name(),
                                 1e-9 * static_cast<double>(now_ns - lost_ns_)));
    state_ = CameraState::Streaming;
  }
  if (const auto refused = device_.give_back(newest.filled)) lose(*refused, now_ns);
}

void Streamer::recover(std::int64_t now_ns) {
  switch (recovery_.due(now_ns)) {
    case Recovery::Action::None:
      return;
    case Recovery::Action::Restart:
      say_lost("no picture in time; its stream is begun anew", now_ns);
      return restart(now_ns);
    case Recovery::Action::Close:
      return lose("no picture after its stream was begun anew", now_ns);
    case Recovery::Action::Open:
      return reopen(now_ns);
  }
}

void Streamer::restart(std::int64_t now_ns) {
  if (const auto fault = begin_stream()) lose(*fault, now_ns);
}

void Streamer::reopen(std::int64_t now_ns) {
  const std::optional<std::string> fault = open_and_begin(now_ns);
  if (!fault) {
    reopen_fault_.clear();
    return;
  }
  if (*fault != std::exchange(reopen_fault_, *fault)) {
    config::log_info(name() + ": waiting for it: " + *fault);
  }
  close_device(now_ns);
}

void Streamer::lose(const std::string& reason, std::int64_t now_ns) {
  say_lost(reason, now_ns);
  close_device(now_ns);
}

void Streamer::close_device(std::int64_t now_ns) {
  newest_.reset();
  device_.close();
  recovery_.closed(now_ns);
}

void Streamer::say_lost(const std::string& reason, std::int64_t now_ns) {
  if (state_ == CameraState::Lost) return;
  state_ = CameraState::Lost;
  lost_ns_ = now_ns;
  config::log_warning(name() + ": is lost: " + reason);
}

}  // namespace lumibox::hal::live
