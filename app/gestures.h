#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/buttons.h"

namespace lumibox::app {

enum class Press { Short, Long };

/// What a finger meant.
struct Gesture {
  hal::Button button = hal::Button::Main;
  Press press = Press::Short;

  bool operator==(const Gesture&) const = default;
};

/// Turns button edges into short and long presses. A long press is told as soon as the button has
/// been down long enough, so that the person feels when to let go; a short one when it is released.
/// Every press gives exactly one gesture; edges that make no sense (a release without a press, a
/// second press without a release) are passed over.
class Gestures {
 public:
  explicit Gestures(double long_press_s);

  /// Gestures that `edges` complete, or that the time `now_ns` does, oldest first.
  std::vector<Gesture> update(const std::vector<hal::ButtonEvent>& edges, std::int64_t now_ns);

 private:
  std::int64_t long_ns_;
  /// Per button: since when it has been down; none when it is up or its gesture has been told.
  std::array<std::optional<std::int64_t>, 5> down_since_ns_;
};

}  // namespace lumibox::app
