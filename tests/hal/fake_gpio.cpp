#include "hal/fake_gpio.h"

namespace lumibox::testing {

void FakeBoard::drive(FakeLine& line, bool high, std::int64_t time_ns) {
  if (line.high == high) {
    return;
  }
  line.high = high;
  if (!line.tells_edges) {
    return;
  }
  // The first of the kernel's interfaces drops the newest, the second the oldest.
  const bool is_full = line.edges.size() == line.kept_edges;
  if (is_full && kFakeLibgpiod == 1) {
    return;
  }
  if (is_full) {
    line.edges.pop_front();
  }
  line.edges.push_back({line.is_active(), time_ns});
}

FakeLine* FakeBoard::line_named(const std::string& name) {
  for (FakeChip& chip : chips) {
    for (FakeLine& line : chip.lines) {
      if (line.name == name) {
        return &line;
      }
    }
  }
  return nullptr;
}

FakeBoard& fake_board() {
  static FakeBoard board;
  return board;
}

}  // namespace lumibox::testing
