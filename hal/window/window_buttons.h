#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/config.h"
#include "hal/buttons.h"
#include "hal/clock.h"
#include "hal/evdev/held_keys.h"
#include "hal/hold_guard.h"
#include "hal/window/key_edges.h"

namespace lumibox::hal {

/// The keys of a window as buttons, while it has the keyboard: the same keys as of a keyboard that
/// the box has for itself.
class WindowButtons : public Buttons {
 public:
  /// Throws config::InputError for keys that make no sense.
  WindowButtons(std::shared_ptr<KeyEdges> keys, const config::Evdev& options, double stuck_s,
                const Clock& clock);

  std::vector<ButtonEvent> poll() override;
  std::optional<std::string> error() const override { return guard_.error(); }

 private:
  std::shared_ptr<KeyEdges> keys_;
  const Clock& clock_;
  HeldKeys held_;
  HoldGuard guard_;
};

}  // namespace lumibox::hal
