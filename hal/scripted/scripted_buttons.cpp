#include "hal/scripted/scripted_buttons.h"

#include <algorithm>
#include <utility>

namespace lumibox::hal {

ScriptedButtons::ScriptedButtons(std::vector<ButtonEvent> events, const Clock& clock)
    : events_(std::move(events)), clock_(clock) {
  std::ranges::stable_sort(events_, {}, &ButtonEvent::timestamp_ns);
  // The system's clock has been running since long before.
  const std::int64_t start_ns = clock_.now_ns();
  for (ButtonEvent& event : events_) event.timestamp_ns += start_ns;
}

std::vector<ButtonEvent> ScriptedButtons::poll() {
  const std::int64_t now_ns = clock_.now_ns();
  std::vector<ButtonEvent> due;
  for (; next_ < events_.size() && events_[next_].timestamp_ns <= now_ns; ++next_) {
    due.push_back(events_[next_]);
  }
  return due;
}

}  // namespace lumibox::hal
