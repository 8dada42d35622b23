#include "hal/libcamera/libcamera_device.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "config/log.h"
#include "hal/live/refusal.h"

namespace lumibox::hal::libcam {

LibcameraDevice::LibcameraDevice(std::unique_ptr<CameraSystem> system, Request request,
                                 Connection connection)
    : system_(std::move(system)),
      request_(std::move(request)),
      connection_(std::move(connection)) {}

std::optional<std::string> LibcameraDevice::open() {
  auto found = connect(*system_, request_);
  if (const auto* fault = std::get_if<std::string>(&found)) return *fault;
  connection_ = std::get<Connection>(std::move(found));
  return std::nullopt;
}

void LibcameraDevice::close() {
  end();
  connection_.camera.reset();
}

std::optional<std::string> LibcameraDevice::begin() {
  end();
  const int refused = connection_.camera->start(complete(hold_.begin()));
  streaming_ = refused == 0;
  return streaming_ ? std::nullopt : std::optional(live::refusal("does not stream", refused));
}

void LibcameraDevice::end() {
  if (std::exchange(streaming_, false)) connection_.camera->stop();
}

live::Device::Taken LibcameraDevice::take() {
  const std::optional<Completed> completed = connection_.camera->take();
  if (!completed) return std::monostate();
  if (completed->status == Completed::Status::Success) hold_.saw(completed->adjustments);
  return filled_of(*completed);
}

std::optional<std::string> LibcameraDevice::give_back(const live::Filled& filled) {
  std::optional<Orders> orders = hold_.take_orders();
  if (orders) orders = complete(*orders);
  const int refused = connection_.camera->queue(filled.buffer, orders);
  if (refused == 0) return std::nullopt;
  return live::refusal("it takes no requests", refused);
}

std::optional<std::string> LibcameraDevice::loss() {
  return connection_.camera->is_removed() ? std::optional<std::string>("it was removed")
                                          : std::nullopt;
}

void LibcameraDevice::update_hold(bool wanted) {
  hold_.want(wanted);
  const std::optional<std::string> news = hold_.take_news();
  if (!news) return;
  const std::string line = fmt::format("camera {}: {}", name(), *news);
  if (hold_.is_fault()) {
    config::log_warning(line);
  } else {
    config::log_info(line);
  }
}

/// With the rate that was chosen, so that no exposure in the dark makes it lower.
Orders LibcameraDevice::complete(Orders orders) const {
  const std::uint32_t duration_us = connection_.layout.mode.interval.numerator;
  if (duration_us != 0) orders.frame_duration_us = duration_us;
  return orders;
}

live::Filled LibcameraDevice::filled_of(const Completed& completed) const {
  live::Filled filled;
  filled.buffer = completed.request;
  filled.sequence = completed.sequence;
  filled.monotonic = true;
  filled.start_of_exposure = completed.exposure_begin_ns.has_value();
  filled.timestamp_ns = completed.exposure_begin_ns.value_or(completed.timestamp_ns);
  filled.faulty = completed.status != Completed::Status::Success;
  // A plane may have more rows than the picture.
  const std::vector<std::size_t> sizes = live::plane_sizes(connection_.layout);
  const bool by_planes = completed.planes.size() == sizes.size();
  for (std::size_t i = 0; i < std::min(completed.planes.size(), filled.bytes.size()); ++i) {
    const auto& plane = completed.planes[i];
    filled.bytes[i] = by_planes ? plane.first(std::min(plane.size(), sizes[i])) : plane;
  }
  return filled;
}

}  // namespace lumibox::hal::libcam
