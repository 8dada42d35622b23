#include "app/gestures.h"

#include <cmath>
#include <cstddef>

namespace lumibox::app {

Gestures::Gestures(double long_press_s)
    : long_ns_(static_cast<std::int64_t>(std::llround(long_press_s * 1e9))) {}

std::vector<Gesture> Gestures::update(const std::vector<hal::ButtonEvent>& edges,
                                      std::int64_t now_ns) {
  std::vector<Gesture> gestures;
  for (const hal::ButtonEvent& edge : edges) {
    auto& since = down_since_ns_.at(static_cast<std::size_t>(edge.button));
    if (edge.action == hal::ButtonAction::Pressed) {
      since = edge.timestamp_ns;
    } else if (since) {
      const bool is_long = edge.timestamp_ns - *since >= long_ns_;
      gestures.push_back({edge.button, is_long ? Press::Long : Press::Short});
      since.reset();
    }
  }
  for (std::size_t i = 0; i < down_since_ns_.size(); ++i) {
    if (down_since_ns_[i] && now_ns - *down_since_ns_[i] >= long_ns_) {
      gestures.push_back({static_cast<hal::Button>(i), Press::Long});
      down_since_ns_[i].reset();
    }
  }
  return gestures;
}

}  // namespace lumibox::app
