#include "hal/v4l2/streamer.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <utility>

#include "config/error_text.h"
#include "config/log.h"

namespace lumibox::hal::v4l2 {
namespace {

/// Pictures, many times what the ring holds: a driver that fills buffers faster than they are
/// emptied must not hold us up.
constexpr int kMostAtOnce = 64;

std::int64_t patience_ns(const Layout& layout, const Request& request, int stall_periods) {
  const double rate = layout.mode.interval.rate_hz();
  return std::llround(1e9 * stall_periods / (rate > 0.0 ? rate : request.wish.rate_hz));
}

}  // namespace

Streamer::Streamer(VideoSystem& system, FrameSlot& slot, Request request, Connection connection,
                   const StreamSettings& settings)
    : system_(system),
      slot_(slot),
      request_(again(request, connection)),
      connection_(std::move(connection)),
      settings_(settings),
      name_("camera " + connection_.name()),
      recovery_(patience_ns(connection_.layout, request, settings.stall_periods)),
      stamping_(settings.readout_ns) {}

Streamer::~Streamer() = default;

std::optional<std::string> Streamer::start(std::int64_t now_ns) {
  stop();
  numbering_ = Numbering();
  stamping_ = Stamping(settings_.readout_ns);
  said_damage_ = said_stamps_ = false;
  // It may have been lost, or plugged in anew, since it was opened.
  if (!connection_.device || begin_stream(now_ns)) {
    if (auto fault = open_and_begin(now_ns)) {
      close_device(now_ns);
      recovery_.stopped();
      return fault;
    }
  }
  state_ = CameraState::Streaming;
  free_what_was_left_held();
  return std::nullopt;
}

void Streamer::free_what_was_left_held() {
  const Automatic automatic = make_automatic(*connection_.device);
  if (!automatic.switched.empty()) {
    config::log_info(
        fmt::format("{}: as by default again: {}", name_, fmt::join(automatic.switched, ", ")));
  }
  say_faults(automatic.faults);
}

void Streamer::stop() {
  // A camera keeps what was set in it, and whoever has it next would take that for its own.
  if (ring_ && hold_.holds()) say_faults(hold_.free(*connection_.device));
  hold_done_.reset();
  newest_.reset();
  ring_.reset();
  recovery_.stopped();
  slot_.clear();
  state_ = CameraState::Stopped;
}

void Streamer::service(std::int64_t now_ns) {
  if (state_ == CameraState::Stopped) return;
  if (system_.changed()) recovery_.device_appeared(now_ns);
  if (ring_) drain(now_ns);
  recover(now_ns);
  if (ring_) update_hold();
}

/// Opens the device anew; the reason if there is none, or none that streams.
std::optional<std::string> Streamer::open_and_begin(std::int64_t now_ns) {
  ring_.reset();
  connection_.device.reset();  // a camera may be opened only once
  auto found = connect(system_, request_);
  if (const auto* fault = std::get_if<std::string>(&found)) return *fault;
  connection_ = std::get<Connection>(std::move(found));
  name_ = "camera " + connection_.name();
  const auto fault = begin_stream(now_ns);
  return fault ? std::optional(connection_.name() + ": " + *fault) : std::nullopt;
}

std::optional<std::string> Streamer::begin_stream(std::int64_t now_ns) {
  ring_.emplace(*connection_.device);
  if (settings_.power_line) say_faults(set_controls(*connection_.device, {*settings_.power_line}));
  hold_done_.reset();  // the device may have forgotten
  numbering_.begin_stream();
  recovery_.began(now_ns);
  return ring_->begin();
}

void Streamer::update_hold() {
  const bool wanted = hold_wanted_;
  if (wanted == hold_done_) return;
  hold_done_ = wanted;
  if (wanted) {
    const auto faults = hold_.hold(*connection_.device);
    config::log_info(fmt::format("{}: held: {}", name_, hold_.description()));
    say_faults(faults);
  } else {
    say_faults(hold_.free(*connection_.device));
  }
}

void Streamer::drain(std::int64_t now_ns) {
  int error = 0;
  Filled filled;
  for (int i = 0; i < kMostAtOnce; ++i) {
    if ((error = ring_->take(filled)) != 0) break;
    if (accept(filled, now_ns)) continue;
    if (const int refused = ring_->give_back(filled); refused != 0) {
      return lose("it takes no buffers: " + config::error_text(refused), now_ns);
    }
  }
  if (error != 0 && error != EAGAIN) return lose(config::error_text(error), now_ns);
  const bool any = newest_.has_value();
  hand_over(now_ns);
  if (ring_ && !any && connection_.device->hung_up()) lose("it hung up", now_ns);
}

/// Whether the buffer is kept, as the newest so far; the one before goes back to the camera.
bool Streamer::accept(const Filled& filled, std::int64_t now_ns) {
  const std::int64_t index = numbering_.next(filled.sequence);
  const Damage damage = damage_of(filled, connection_.layout);
  slot_.count_dropped(numbering_.missed() + (damage != Damage::None ? 1 : 0));
  if (damage != Damage::None) {
    if (!std::exchange(said_damage_, true)) {
      config::log_warning(fmt::format("{}: a damaged picture is left out, as others will be: {}",
                                      name_, to_string(damage)));
    }
    return false;
  }
  const std::int64_t timestamp_ns = stamping_.stamp(filled, now_ns);
  if (stamping_.replaced() && !std::exchange(said_stamps_, true)) {
    config::log_warning(name_ + ": its times cannot be used; pictures get the time they come at");
  }
  const std::optional<Newest> older = std::exchange(newest_, Newest{filled, index, timestamp_ns});
  if (older) {
    slot_.count_dropped(1);
    ring_->give_back(older->filled);  // an error shows again at the next buffer
  }
  return true;
}

/// The copy lets the camera have its buffer back at once, and outlives the device. Undecoded it is
/// quick: nothing of what is displaced later has cost more.
void Streamer::hand_over(std::int64_t now_ns) {
  if (!newest_) return;
  const Newest newest = *std::exchange(newest_, std::nullopt);
  slot_.put({connection_.layout,
             {newest.filled.bytes.begin(), newest.filled.bytes.end()},
             newest.index,
             newest.timestamp_ns});
  recovery_.got_frame(now_ns);
  if (state_ == CameraState::Lost) {
    config::log_info(fmt::format("{}: is back after {:.1f} s", name_,
                                 1e-9 * static_cast<double>(now_ns - lost_ns_)));
    state_ = CameraState::Streaming;
  }
  if (const int refused = ring_->give_back(newest.filled); refused != 0) {
    lose("it takes no buffers: " + config::error_text(refused), now_ns);
  }
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
  ring_.reset();
  ring_.emplace(*connection_.device);
  numbering_.begin_stream();
  if (const auto fault = ring_->begin()) lose(*fault, now_ns);
}

void Streamer::reopen(std::int64_t now_ns) {
  const std::optional<std::string> fault = open_and_begin(now_ns);
  if (!fault) {
    reopen_fault_.clear();
    return;
  }
  if (*fault != std::exchange(reopen_fault_, *fault)) {
    config::log_info(name_ + ": waiting for it: " + *fault);
  }
  close_device(now_ns);
}

void Streamer::lose(const std::string& reason, std::int64_t now_ns) {
  say_lost(reason, now_ns);
  close_device(now_ns);
}

void Streamer::close_device(std::int64_t now_ns) {
  newest_.reset();
  ring_.reset();
  connection_.device.reset();
  recovery_.closed(now_ns);
}

void Streamer::say_lost(const std::string& reason, std::int64_t now_ns) {
  if (state_ == CameraState::Lost) return;
  state_ = CameraState::Lost;
  lost_ns_ = now_ns;
  config::log_warning(name_ + ": is lost: " + reason);
}

void Streamer::say_faults(const std::vector<std::string>& faults) {
  for (const std::string& fault : faults) config::log_warning(name_ + ": " + fault);
}

}  // namespace lumibox::hal::v4l2
