#include "hal/v4l2/v4l2_device.h"

#include <fmt/format.h>

#include <cerrno>
#include <utility>
#include <variant>

#include "config/error_text.h"
#include "config/log.h"

namespace lumibox::hal::v4l2 {

V4l2Device::V4l2Device(std::unique_ptr<VideoSystem> system, Request request, Connection connection,
                       const std::optional<Setting>& power_line)
    : system_(std::move(system)),
      request_(std::move(request)),
      connection_(std::move(connection)),
      power_line_(power_line) {}

std::optional<std::string> V4l2Device::open() {
  auto found = connect(*system_, request_);
  if (const auto* fault = std::get_if<std::string>(&found)) return *fault;
  connection_ = std::get<Connection>(std::move(found));
  return std::nullopt;
}

void V4l2Device::close() {
  ring_.reset();
  connection_.device.reset();
}

std::optional<std::string> V4l2Device::begin() {
  ring_.reset();  // frees its buffers before others are asked for
  ring_.emplace(*connection_.device);
  if (power_line_) say_faults(set_controls(*connection_.device, {*power_line_}));
  hold_done_.reset();  // the device may have forgotten
  if (auto fault = ring_->begin()) return fault;
  if (!hold_.holds()) free_what_was_left_held();
  return std::nullopt;
}

void V4l2Device::free_what_was_left_held() {
  const Automatic automatic = make_automatic(*connection_.device);
  if (!automatic.switched.empty()) {
    config::log_info(fmt::format("camera {}: as by default again: {}", name(),
                                 fmt::join(automatic.switched, ", ")));
  }
  say_faults(automatic.faults);
}

live::Device::Taken V4l2Device::take() {
  live::Filled filled;
  const int error = ring_->take(filled);
  if (error == 0) return filled;
  if (error == EAGAIN) return std::monostate();
  return config::error_text(error);
}

std::optional<std::string> V4l2Device::give_back(const live::Filled& filled) {
  const int refused = ring_->give_back(filled);
  if (refused == 0) return std::nullopt;
  return "it takes no buffers: " + config::error_text(refused);
}

std::optional<std::string> V4l2Device::loss() {
  return connection_.device->hung_up() ? std::optional<std::string>("it hung up") : std::nullopt;
}

void V4l2Device::update_hold(bool wanted) {
  if (wanted == hold_done_) return;
  hold_done_ = wanted;
  if (wanted) {
    const auto faults = hold_.hold(*connection_.device);
    config::log_info(fmt::format("camera {}: held: {}", name(), hold_.description()));
    say_faults(faults);
  } else {
    say_faults(hold_.free(*connection_.device));
  }
}

void V4l2Device::forget_hold() {
  if (ring_ && hold_.holds()) say_faults(hold_.free(*connection_.device));
  hold_done_.reset();
}

void V4l2Device::say_faults(const std::vector<std::string>& faults) const {
  for (const std::string& fault : faults) {
    config::log_warning(fmt::format("camera {}: {}", name(), fault));
  }
}

}  // namespace lumibox::hal::v4l2
