// The calls of libgpiod 1.x that hal/gpiod/libgpiod_1.cpp makes, on a FakeBoard. They are declared
// by the library's own header, and do what its comments say.

#include <gpiod.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <string>

#include "hal/fake_gpio.h"

using lumibox::testing::fake_board;
using lumibox::testing::FakeChip;
using lumibox::testing::FakeEdge;
using lumibox::testing::FakeLine;

const int lumibox::testing::kFakeLibgpiod = 1;

struct gpiod_line {
  gpiod_chip* chip;
  FakeLine* line;
};

struct gpiod_chip {
  std::vector<gpiod_line> lines;
};

namespace {

gpiod_chip* open_chip(FakeChip& chip) {
  auto* const opened = new gpiod_chip;
  ++fake_board().open_objects;
  for (FakeLine& line : chip.lines) opened->lines.push_back({opened, &line});
  return opened;
}

/// As the library does: one chip that may not be opened spoils the search.
bool is_any_chip_denied() {
  return std::ranges::any_of(fake_board().chips, &FakeChip::is_denied);
}

template <typename T>
T fails(int error, T with) {
  errno = error;
  return with;
}

}  // namespace

void gpiod_chip_close(gpiod_chip* chip) {
  for (const gpiod_line& line : chip->lines) {
    if (line.line->user == "lumibox") {
      line.line->user.clear();
    }
  }
  delete chip;
  --fake_board().open_objects;
}

gpiod_line* gpiod_line_find(const char* name) {
  if (is_any_chip_denied()) {
    return fails<gpiod_line*>(EACCES, nullptr);
  }
  for (FakeChip& chip : fake_board().chips) {
    for (std::size_t i = 0; i < chip.lines.size(); ++i) {
      if (chip.lines[i].name == name) {
        return &open_chip(chip)->lines[i];
      }
    }
  }
  return fails<gpiod_line*>(ENOENT, nullptr);
}

gpiod_chip* gpiod_line_get_chip(gpiod_line* line) {
  return line->chip;
}

gpiod_chip* gpiod_chip_open_lookup(const char* descr) {
  const std::string wanted = descr;
  for (std::size_t i = 0; i < fake_board().chips.size(); ++i) {
    FakeChip& chip = fake_board().chips[i];
    if (wanted == chip.name || wanted == chip.label || wanted == "/dev/" + chip.name ||
        wanted == std::to_string(i)) {
      return chip.is_denied ? fails<gpiod_chip*>(EACCES, nullptr) : open_chip(chip);
    }
  }
  return fails<gpiod_chip*>(ENOENT, nullptr);
}

unsigned int gpiod_chip_num_lines(gpiod_chip* chip) {
  return static_cast<unsigned int>(chip->lines.size());
}

gpiod_line* gpiod_chip_get_line(gpiod_chip* chip, unsigned int offset) {
  return offset < chip->lines.size() ? &chip->lines[offset] : fails<gpiod_line*>(EINVAL, nullptr);
}

const char* gpiod_line_consumer(gpiod_line* line) {
  return line->line->user.empty() ? nullptr : line->line->user.c_str();
}

int gpiod_line_request(gpiod_line* line, const gpiod_line_request_config* config, int value) {
  FakeLine& fake = *line->line;
  if (!fake.user.empty()) {
    return fails(EBUSY, -1);
  }
  fake.user = config->consumer;
  fake.is_input = config->request_type != GPIOD_LINE_REQUEST_DIRECTION_OUTPUT;
  fake.tells_edges = config->request_type == GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES;
  fake.active_low = (config->flags & GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW) != 0;
  fake.bias = (config->flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP) != 0     ? "pull-up"
              : (config->flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN) != 0 ? "pull-down"
              : (config->flags & GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE) != 0   ? "disabled"
                                                                              : "as-is";
  if (!fake.is_input) {
    fake.high = (value != 0) != fake.active_low;
  }
  return 0;
}

int gpiod_line_event_wait(gpiod_line* line, const timespec* timeout) {
  EXPECT_TRUE(timeout != nullptr && timeout->tv_sec == 0 && timeout->tv_nsec == 0)
      << "it would block";
  return static_cast<int>(line->line->hangs_up || !line->line->edges.empty());
}

int gpiod_line_event_read_multiple(gpiod_line* line, gpiod_line_event* events,
                                   unsigned int num_events) {
  if (line->line->gone) {
    return fails(ENODEV, -1);
  }
  std::deque<FakeEdge>& edges = line->line->edges;
  EXPECT_FALSE(edges.empty()) << "it would block";
  unsigned int count = 0;
  for (; count < num_events && !edges.empty(); ++count) {
    const FakeEdge& edge = edges.front();
    events[count].ts = {edge.time_ns / 1'000'000'000, edge.time_ns % 1'000'000'000};
    events[count].event_type =
        edge.rising ? GPIOD_LINE_EVENT_RISING_EDGE : GPIOD_LINE_EVENT_FALLING_EDGE;
    edges.pop_front();
  }
  return static_cast<int>(count);
}

int gpiod_line_get_value(gpiod_line* line) {
  return line->line->gone ? fails(ENODEV, -1) : static_cast<int>(line->line->is_active());
}

int gpiod_line_set_value(gpiod_line* line, int value) {
  if (line->line->gone) {
    return fails(ENODEV, -1);
  }
  line->line->high = (value != 0) != line->line->active_low;
  return 0;
}
