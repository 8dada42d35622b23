#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/buttons.h"

namespace lumibox::hal {

/// Passes on the edges of a source's buttons, but for buttons that are down without a finger: one
/// that is down when the source begins says nothing until it has been released; one that is down
/// for longer than any press is stuck, counts as released, and says nothing more until it is.
class HoldGuard {
 public:
  explicit HoldGuard(double stuck_s);

  void held_at_start(Button button, std::int64_t now_ns);

  /// `edges`, of which those of each button are in order, less what must not be heard. Oldest
  /// first.
  std::vector<ButtonEvent> pass(const std::vector<ButtonEvent>& edges, std::int64_t now_ns);

  /// Which buttons are stuck; none if no one is.
  std::optional<std::string> error() const;

 private:
  struct Hold {
    std::int64_t since_ns = 0;
    bool heard = true;   ///< its press was passed on, and its release is still to be
    bool stuck = false;  ///< has been said in the log
  };

  std::vector<ButtonEvent> newly_stuck(std::int64_t now_ns);

  std::int64_t stuck_ns_;
  std::array<std::optional<Hold>, 5> holds_;  ///< by Button; of those that are down
};

}  // namespace lumibox::hal
