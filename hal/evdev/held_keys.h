#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "hal/evdev/key_map.h"

namespace lumibox::hal {

/// Which keys are down, and by that which buttons: two keys of one button are one.
class HeldKeys {
 public:
  explicit HeldKeys(KeyMap keys) : keys_(std::move(keys)) {}

  /// A key goes down or up. What comes of it for its button: nothing if the key is of none, if it
  /// was so already (a key that is held repeats), or if another key holds the button.
  std::optional<ButtonEvent> take(unsigned code, bool down, std::int64_t time_ns);

  /// All keys go up.
  std::vector<ButtonEvent> release_all(std::int64_t time_ns);

 private:
  bool is_down(Button button) const;

  KeyMap keys_;
  std::set<unsigned> held_;  ///< keys
};

}  // namespace lumibox::hal
