// The calls of libgpiod 2.x that hal/gpiod/libgpiod_2.cpp makes, on a FakeBoard.

#include <gtest/gtest.h>

#include <cerrno>
#include <string>

#include "hal/fake_gpio.h"
#include "hal/libgpiod_2/gpiod.h"

using lumibox::testing::fake_board;
using lumibox::testing::FakeChip;
using lumibox::testing::FakeEdge;
using lumibox::testing::FakeLine;

const int lumibox::testing::kFakeLibgpiod = 2;

struct gpiod_chip {
  FakeChip* chip;
};

struct gpiod_chip_info {
  std::string name;
  std::string label;
  std::size_t lines;
};

struct gpiod_line_info {
  std::string consumer;
};

struct gpiod_line_settings {
  gpiod_line_direction direction = GPIOD_LINE_DIRECTION_AS_IS;
  gpiod_line_edge edge = GPIOD_LINE_EDGE_NONE;
  gpiod_line_bias bias = GPIOD_LINE_BIAS_AS_IS;
  gpiod_line_clock clock = GPIOD_LINE_CLOCK_REALTIME;  // not what is needed
  gpiod_line_value output = GPIOD_LINE_VALUE_ACTIVE;   // likewise
  bool active_low = false;
};

struct gpiod_line_config {
  unsigned int offset = 0;
  gpiod_line_settings settings;
};

struct gpiod_request_config {
  std::string consumer;
  std::size_t event_buffer_size = 16;
};

struct gpiod_line_request {
  FakeLine* line;
  unsigned int offset;
};

struct gpiod_edge_event {
  FakeEdge edge;
};

struct gpiod_edge_event_buffer {
  std::size_t capacity;
  std::vector<gpiod_edge_event> events;
};

namespace {

template <typename T>
T* made(T* object) {
  ++fake_board().open_objects;
  return object;
}

template <typename T>
void freed(T* object) {
  --fake_board().open_objects;
  delete object;
}

template <typename T>
T fails(int error, T with) {
  errno = error;
  return with;
}

FakeChip* chip_at(const std::string& path) {
  for (FakeChip& chip : fake_board().chips) {
    if (path == "/dev/" + chip.name) {
      return &chip;
    }
  }
  return nullptr;
}

void drive(FakeLine& line, gpiod_line_value value) {
  line.high = (value == GPIOD_LINE_VALUE_ACTIVE) != line.active_low;
}

std::string name_of(gpiod_line_bias bias) {
  switch (bias) {
    case GPIOD_LINE_BIAS_PULL_UP:
      return "pull-up";
    case GPIOD_LINE_BIAS_PULL_DOWN:
      return "pull-down";
    case GPIOD_LINE_BIAS_DISABLED:
      return "disabled";
    default:
      return "as-is";
  }
}

}  // namespace

bool gpiod_is_gpiochip_device(const char* path) {
  return chip_at(path) != nullptr;
}

gpiod_chip* gpiod_chip_open(const char* path) {
  FakeChip* const chip = chip_at(path);
  return chip->is_denied ? fails<gpiod_chip*>(EACCES, nullptr) : made(new gpiod_chip{chip});
}

void gpiod_chip_close(gpiod_chip* chip) {
  freed(chip);
}

gpiod_chip_info* gpiod_chip_get_info(gpiod_chip* chip) {
  return made(new gpiod_chip_info{chip->chip->name, chip->chip->label, chip->chip->lines.size()});
}

void gpiod_chip_info_free(gpiod_chip_info* info) {
  freed(info);
}

const char* gpiod_chip_info_get_name(gpiod_chip_info* info) {
  return info->name.c_str();
}

std::size_t gpiod_chip_info_get_num_lines(gpiod_chip_info* info) {
  return info->lines;
}

const char* gpiod_chip_info_get_label(gpiod_chip_info* info) {
  return info->label.c_str();
}

int gpiod_chip_get_line_offset_from_name(gpiod_chip* chip, const char* name) {
  for (std::size_t i = 0; i < chip->chip->lines.size(); ++i) {
    if (chip->chip->lines[i].name == name) {
      return static_cast<int>(i);
    }
  }
  return fails(ENOENT, -1);
}

gpiod_line_info* gpiod_chip_get_line_info(gpiod_chip* chip, unsigned int offset) {
  if (offset >= chip->chip->lines.size()) {
    return fails<gpiod_line_info*>(EINVAL, nullptr);
  }
  return made(new gpiod_line_info{chip->chip->lines[offset].user});
}

void gpiod_line_info_free(gpiod_line_info* info) {
  freed(info);
}

const char* gpiod_line_info_get_consumer(gpiod_line_info* info) {
  return info->consumer.empty() ? nullptr : info->consumer.c_str();
}

gpiod_line_settings* gpiod_line_settings_new() {
  return made(new gpiod_line_settings);
}

void gpiod_line_settings_free(gpiod_line_settings* settings) {
  freed(settings);
}

int gpiod_line_settings_set_direction(gpiod_line_settings* settings,
                                      gpiod_line_direction direction) {
  settings->direction = direction;
  return 0;
}

int gpiod_line_settings_set_edge_detection(gpiod_line_settings* settings, gpiod_line_edge edge) {
  settings->edge = edge;
  return 0;
}

int gpiod_line_settings_set_bias(gpiod_line_settings* settings, gpiod_line_bias bias) {
  settings->bias = bias;
  return 0;
}

void gpiod_line_settings_set_active_low(gpiod_line_settings* settings, bool active_low) {
  settings->active_low = active_low;
}

int gpiod_line_settings_set_event_clock(gpiod_line_settings* settings,
                                        gpiod_line_clock event_clock) {
  settings->clock = event_clock;
  return 0;
}

int gpiod_line_settings_set_output_value(gpiod_line_settings* settings, gpiod_line_value value) {
  settings->output = value;
  return 0;
}

gpiod_line_config* gpiod_line_config_new() {
  return made(new gpiod_line_config);
}

void gpiod_line_config_free(gpiod_line_config* config) {
  freed(config);
}

int gpiod_line_config_add_line_settings(gpiod_line_config* config, const unsigned int* offsets,
                                        size_t num_offsets, gpiod_line_settings* settings) {
  EXPECT_EQ(num_offsets, 1U);
  config->offset = offsets[0];
  config->settings = *settings;
  return 0;
}

gpiod_request_config* gpiod_request_config_new() {
  return made(new gpiod_request_config);
}

void gpiod_request_config_free(gpiod_request_config* config) {
  freed(config);
}

void gpiod_request_config_set_consumer(gpiod_request_config* config, const char* consumer) {
  config->consumer = consumer;
}

void gpiod_request_config_set_event_buffer_size(gpiod_request_config* config,
                                                size_t event_buffer_size) {
  config->event_buffer_size = event_buffer_size;
}

gpiod_line_request* gpiod_chip_request_lines(gpiod_chip* chip, gpiod_request_config* req_cfg,
                                             gpiod_line_config* line_cfg) {
  FakeLine& line = chip->chip->lines.at(line_cfg->offset);
  const gpiod_line_settings& settings = line_cfg->settings;
  if (!line.user.empty()) {
    return fails<gpiod_line_request*>(EBUSY, nullptr);
  }
  line.user = req_cfg->consumer;
  line.is_input = settings.direction == GPIOD_LINE_DIRECTION_INPUT;
  line.tells_edges =
      settings.edge == GPIOD_LINE_EDGE_BOTH && settings.clock == GPIOD_LINE_CLOCK_MONOTONIC;
  line.kept_edges = req_cfg->event_buffer_size;
  line.active_low = settings.active_low;
  line.bias = name_of(settings.bias);
  if (settings.direction == GPIOD_LINE_DIRECTION_OUTPUT) {
    drive(line, settings.output);
  }
  return made(new gpiod_line_request{&line, line_cfg->offset});
}

void gpiod_line_request_release(gpiod_line_request* request) {
  request->line->user.clear();
  freed(request);
}

gpiod_line_value gpiod_line_request_get_value(gpiod_line_request* request, unsigned int offset) {
  EXPECT_EQ(offset, request->offset);
  if (request->line->gone) {
    return fails(ENODEV, GPIOD_LINE_VALUE_ERROR);
  }
  return request->line->is_active() ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
}

int gpiod_line_request_set_value(gpiod_line_request* request, unsigned int offset,
                                 gpiod_line_value value) {
  EXPECT_EQ(offset, request->offset);
  if (request->line->gone) {
    return fails(ENODEV, -1);
  }
  drive(*request->line, value);
  return 0;
}

int gpiod_line_request_wait_edge_events(gpiod_line_request* request, int64_t timeout_ns) {
  EXPECT_EQ(timeout_ns, 0) << "it would block";
  return static_cast<int>(request->line->hangs_up || !request->line->edges.empty());
}

int gpiod_line_request_read_edge_events(gpiod_line_request* request,
                                        gpiod_edge_event_buffer* buffer, size_t max_events) {
  if (request->line->gone) {
    return fails(ENODEV, -1);
  }
  std::deque<FakeEdge>& edges = request->line->edges;
  EXPECT_FALSE(edges.empty()) << "it would block";
  EXPECT_LE(max_events, buffer->capacity);
  buffer->events.clear();
  for (; buffer->events.size() < max_events && !edges.empty(); edges.pop_front()) {
    buffer->events.push_back({edges.front()});
  }
  return static_cast<int>(buffer->events.size());
}

gpiod_edge_event_buffer* gpiod_edge_event_buffer_new(size_t capacity) {
  return made(new gpiod_edge_event_buffer{capacity, {}});
}

void gpiod_edge_event_buffer_free(gpiod_edge_event_buffer* buffer) {
  freed(buffer);
}

gpiod_edge_event* gpiod_edge_event_buffer_get_event(gpiod_edge_event_buffer* buffer,
                                                    unsigned long index) {
  return &buffer->events.at(index);
}

gpiod_edge_event_type gpiod_edge_event_get_event_type(gpiod_edge_event* event) {
  return event->edge.rising ? GPIOD_EDGE_EVENT_RISING_EDGE : GPIOD_EDGE_EVENT_FALLING_EDGE;
}

uint64_t gpiod_edge_event_get_timestamp_ns(gpiod_edge_event* event) {
  return static_cast<uint64_t>(event->edge.time_ns);
}
