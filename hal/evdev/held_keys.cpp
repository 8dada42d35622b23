#include "hal/evdev/held_keys.h"

#include <algorithm>

namespace lumibox::hal {

std::optional<ButtonEvent> HeldKeys::take(unsigned code, bool down, std::int64_t time_ns) {
  const auto key = keys_.find(code);
  if (key == keys_.end()) {
    return std::nullopt;
  }
  const Button button = key->second;
  const bool was_down = is_down(button);
  if (down) {
    held_.insert(code);
  } else {
    held_.erase(code);
  }
  if (was_down == is_down(button)) {
    return std::nullopt;
  }
  return ButtonEvent{button, was_down ? ButtonAction::Released : ButtonAction::Pressed, time_ns};
}

std::vector<ButtonEvent> HeldKeys::release_all(std::int64_t time_ns) {
  std::vector<ButtonEvent> edges;
  for (const unsigned code : std::set(held_)) {
    if (const auto edge = take(code, false, time_ns)) edges.push_back(*edge);
  }
  return edges;
}

bool HeldKeys::is_down(Button button) const {
  return std::ranges::any_of(held_, [&](unsigned code) { return keys_.at(code) == button; });
}

}  // namespace lumibox::hal
