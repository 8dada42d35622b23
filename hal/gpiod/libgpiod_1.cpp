// On libgpiod 1.x, which has the first of the kernel's interfaces. Kernels from 5.7 on stamp its
// events with CLOCK_MONOTONIC and say the level after the edge, as a line that is active low has
// it.

#include <gpiod.h>

#include <array>
#include <cerrno>
#include <utility>

#include "hal/gpiod/gpio_line.h"
#include "hal/owned.h"

namespace lumibox::hal {
namespace {

constexpr const char* kConsumer = "lumibox";

/// That the kernel keeps of a line; of more, it drops the newest.
constexpr unsigned kKeptEdges = 16;

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

struct OpenLine {
  std::unique_ptr<gpiod_chip, Freed<gpiod_chip_close>> chip;  ///< closing it releases the line
  gpiod_line* line = nullptr;
};

OpenLine find(const LineRequest& request) {
  const LinePlace place = place_of(request);
  OpenLine found;
  if (place.chip.empty()) {
    found.line = gpiod_line_find(place.name.c_str());
    if (found.line != nullptr) {
      found.chip.reset(gpiod_line_get_chip(found.line));
    }
  } else {
    found.chip.reset(gpiod_chip_open_lookup(place.chip.c_str()));
    if (!found.chip) {
      throw no_such_chip(request, errno);
    }
    const unsigned lines = gpiod_chip_num_lines(found.chip.get());
    if (place.offset >= lines) {
      throw no_such_offset(request, lines);
    }
    found.line = gpiod_chip_get_line(found.chip.get(), place.offset);
  }
  if (found.line == nullptr) {
    throw no_such_line(request, errno);
  }
  return found;
}

int flags_of(const LineRequest& request) {
  int flags = request.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  switch (request.bias) {
    case Bias::AsIs:
      break;
    case Bias::PullUp:
      flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
      break;
    case Bias::PullDown:
      flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
      break;
    case Bias::Disabled:
      flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
      break;
  }
  return flags;
}

OpenLine open(const LineRequest& request, int request_type) {
  OpenLine opened = find(request);
  const gpiod_line_request_config config{kConsumer, request_type, flags_of(request)};
  if (gpiod_line_request(opened.line, &config, /*default_val=*/0) != 0) {
    const int error = errno;
    throw not_given(request, error, gpiod_line_consumer(opened.line));
  }
  return opened;
}

LineEdge edge_of(const gpiod_line_event& event) {
  return {event.event_type == GPIOD_LINE_EVENT_RISING_EDGE,
          event.ts.tv_sec * kNsPerSecond + event.ts.tv_nsec};
}

}  // namespace

struct GpioInput::Line : OpenLine {};

GpioInput::GpioInput(const LineRequest& request)
    : line_(std::make_unique<Line>(open(request, GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES))) {}

GpioInput::~GpioInput() = default;
GpioInput::GpioInput(GpioInput&&) noexcept = default;
GpioInput& GpioInput::operator=(GpioInput&&) noexcept = default;

std::optional<LineReading> GpioInput::read() {
  const timespec at_once{};
  const int pending = gpiod_line_event_wait(line_->line, &at_once);
  std::array<gpiod_line_event, kKeptEdges> events;
  const int count = pending > 0
                        ? gpiod_line_event_read_multiple(line_->line, events.data(), kKeptEdges)
                        : pending;
  if (count < 0) {
    return std::nullopt;
  }
  LineReading reading;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    reading.edges.push_back(edge_of(events.at(i)));
  }
  reading.lost = reading.edges.size() == kKeptEdges;
  const int level = gpiod_line_get_value(line_->line);
  reading.active = level == 1;
  return level < 0 ? std::nullopt : std::optional(std::move(reading));
}

struct GpioOutput::Line : OpenLine {};

GpioOutput::GpioOutput(const LineRequest& request)
    : line_(std::make_unique<Line>(open(request, GPIOD_LINE_REQUEST_DIRECTION_OUTPUT))) {}

GpioOutput::~GpioOutput() {
  set(false);
}

bool GpioOutput::set(bool active) {
  return gpiod_line_set_value(line_->line, active ? 1 : 0) == 0;
}

}  // namespace lumibox::hal
