// On libgpiod 2.x, which has the second of the kernel's interfaces. It stamps events with
// CLOCK_MONOTONIC if asked to and says the level after the edge, as a line that is
// active low has it.

#include <gpiod.h>

#include <cerrno>
#include <utility>

#include "hal/gpiod/gpio_line.h"
#include "hal/owned.h"

namespace lumibox::hal {
namespace {

constexpr const char* kConsumer = "lumibox";

/// That the kernel is asked to keep of a line, instead of 16; of more, it drops the oldest, so that
/// the level is never at odds with the last.
constexpr std::size_t kKeptEdges = 64;

/// The kernel numbers no more chips than these.
constexpr int kMostChips = 256;

using Chip = std::unique_ptr<gpiod_chip, Freed<gpiod_chip_close>>;
using ChipInfo = std::unique_ptr<gpiod_chip_info, Freed<gpiod_chip_info_free>>;
using LineInfo = std::unique_ptr<gpiod_line_info, Freed<gpiod_line_info_free>>;
using Settings = std::unique_ptr<gpiod_line_settings, Freed<gpiod_line_settings_free>>;
using LineConfig = std::unique_ptr<gpiod_line_config, Freed<gpiod_line_config_free>>;
using RequestConfig = std::unique_ptr<gpiod_request_config, Freed<gpiod_request_config_free>>;
using Request = std::unique_ptr<gpiod_line_request, Freed<gpiod_line_request_release>>;
using EventBuffer = std::unique_ptr<gpiod_edge_event_buffer, Freed<gpiod_edge_event_buffer_free>>;

struct FoundLine {
  Chip chip;
  unsigned offset = 0;
};

bool is_called(gpiod_chip* chip, const std::string& path, const std::string& name) {
  const ChipInfo info(gpiod_chip_get_info(chip));
  return name == path || (info && (name == gpiod_chip_info_get_name(info.get()) ||
                                   name == gpiod_chip_info_get_label(info.get())));
}

/// The chip, with the line if that has a name. None if there is none; `error` then says why.
std::optional<FoundLine> find(const LinePlace& place, int& error) {
  error = ENOENT;
  for (int number = 0; number < kMostChips; ++number) {
    const std::string path = "/dev/gpiochip" + std::to_string(number);
    if (!gpiod_is_gpiochip_device(path.c_str())) {
      continue;
    }
    Chip chip(gpiod_chip_open(path.c_str()));
    if (!chip) {
      error = errno;
      continue;
    }
    if (!place.chip.empty()) {
      if (place.chip == std::to_string(number) || is_called(chip.get(), path, place.chip)) {
        return FoundLine{std::move(chip), place.offset};
      }
      continue;
    }
    const int offset = gpiod_chip_get_line_offset_from_name(chip.get(), place.name.c_str());
    if (offset >= 0) {
      return FoundLine{std::move(chip), static_cast<unsigned>(offset)};
    }
  }
  return std::nullopt;
}

FoundLine find(const LineRequest& request) {
  const LinePlace place = place_of(request);
  int error = 0;
  std::optional<FoundLine> found = find(place, error);
  if (!found) {
    throw place.chip.empty() ? no_such_line(request, error) : no_such_chip(request, error);
  }
  const ChipInfo info(gpiod_chip_get_info(found->chip.get()));
  if (info && found->offset >= gpiod_chip_info_get_num_lines(info.get())) {
    throw no_such_offset(request, gpiod_chip_info_get_num_lines(info.get()));
  }
  return *std::move(found);
}

gpiod_line_bias bias_of(const LineRequest& request) {
  switch (request.bias) {
    case Bias::AsIs:
      break;
    case Bias::PullUp:
      return GPIOD_LINE_BIAS_PULL_UP;
    case Bias::PullDown:
      return GPIOD_LINE_BIAS_PULL_DOWN;
    case Bias::Disabled:
      return GPIOD_LINE_BIAS_DISABLED;
  }
  return GPIOD_LINE_BIAS_AS_IS;
}

Settings settings_of(const LineRequest& request, gpiod_line_direction direction) {
  Settings settings(gpiod_line_settings_new());
  if (!settings) {
    throw not_given(request, errno, nullptr);
  }
  gpiod_line_settings_set_direction(settings.get(), direction);
  gpiod_line_settings_set_active_low(settings.get(), request.active_low);
  gpiod_line_settings_set_bias(settings.get(), bias_of(request));
  if (direction == GPIOD_LINE_DIRECTION_INPUT) {
    gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_BOTH);
    gpiod_line_settings_set_event_clock(settings.get(), GPIOD_LINE_CLOCK_MONOTONIC);
  } else {
    gpiod_line_settings_set_output_value(settings.get(), GPIOD_LINE_VALUE_INACTIVE);
  }
  return settings;
}

struct OpenLine {
  Request request;
  unsigned offset = 0;
};

OpenLine open(const LineRequest& request, gpiod_line_direction direction) {
  const FoundLine found = find(request);
  const LineInfo info(gpiod_chip_get_line_info(found.chip.get(), found.offset));
  if (!info) {
    throw no_such_line(request, errno);
  }
  const Settings settings = settings_of(request, direction);
  const LineConfig lines(gpiod_line_config_new());
  const RequestConfig config(gpiod_request_config_new());
  if (!lines || !config ||
      gpiod_line_config_add_line_settings(lines.get(), &found.offset, 1, settings.get()) != 0) {
    throw not_given(request, errno, nullptr);
  }
  gpiod_request_config_set_consumer(config.get(), kConsumer);
  gpiod_request_config_set_event_buffer_size(config.get(), kKeptEdges);
  OpenLine opened{Request(gpiod_chip_request_lines(found.chip.get(), config.get(), lines.get())),
                  found.offset};
  if (!opened.request) {
    throw not_given(request, errno, gpiod_line_info_get_consumer(info.get()));
  }
  return opened;
}

LineEdge edge_of(gpiod_edge_event* event) {
  return {gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE,
          static_cast<std::int64_t>(gpiod_edge_event_get_timestamp_ns(event))};
}

}  // namespace

struct GpioInput::Line {
  OpenLine line;
  EventBuffer events{gpiod_edge_event_buffer_new(kKeptEdges)};
};

GpioInput::GpioInput(const LineRequest& request)
    : line_(std::make_unique<Line>(open(request, GPIOD_LINE_DIRECTION_INPUT))) {
  if (!line_->events) {
    throw not_given(request, errno, nullptr);
  }
}

GpioInput::~GpioInput() = default;
GpioInput::GpioInput(GpioInput&&) noexcept = default;
GpioInput& GpioInput::operator=(GpioInput&&) noexcept = default;

std::optional<LineReading> GpioInput::read() {
  gpiod_line_request* const request = line_->line.request.get();
  const int pending = gpiod_line_request_wait_edge_events(request, /*timeout_ns=*/0);
  const int count =
      pending > 0 ? gpiod_line_request_read_edge_events(request, line_->events.get(), kKeptEdges)
                  : pending;
  if (count < 0) {
    return std::nullopt;
  }
  LineReading reading;
  for (unsigned long i = 0; i < static_cast<unsigned long>(count); ++i) {
    reading.edges.push_back(edge_of(gpiod_edge_event_buffer_get_event(line_->events.get(), i)));
  }
  const gpiod_line_value level = gpiod_line_request_get_value(request, line_->line.offset);
  reading.active = level == GPIOD_LINE_VALUE_ACTIVE;
  return level == GPIOD_LINE_VALUE_ERROR ? std::nullopt : std::optional(std::move(reading));
}

struct GpioOutput::Line : OpenLine {};

GpioOutput::GpioOutput(const LineRequest& request)
    : line_(std::make_unique<Line>(open(request, GPIOD_LINE_DIRECTION_OUTPUT))) {}

GpioOutput::~GpioOutput() {
  set(false);
}

bool GpioOutput::set(bool active) {
  return gpiod_line_request_set_value(
             line_->request.get(), line_->offset,
             active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE) == 0;
}

}  // namespace lumibox::hal
