#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/config.h"
#include "hal/buttons.h"
#include "hal/clock.h"
#include "hal/debouncer.h"
#include "hal/gpiod/gpio_line.h"
#include "hal/hold_guard.h"

namespace lumibox::hal {

/// Buttons wired to lines of the board, debounced here. Edges are stamped by the kernel.
class GpiodButtons : public Buttons {
 public:
  /// `clock` runs with CLOCK_MONOTONIC, as SystemClock does. Throws config::InputError if no button
  /// has a line, or a line cannot be had.
  GpiodButtons(const config::Gpio& options, double stuck_s, const Clock& clock);

  std::vector<ButtonEvent> poll() override;
  std::optional<std::string> error() const override;

 private:
  struct Switch {
    Button button;
    std::optional<GpioInput> line;  ///< none once it is gone
    Debouncer debouncer;
  };

  void add(Button button, const config::Gpio& options, const std::string& line);
  void read(Switch& contact, std::vector<ButtonEvent>& edges);
  void lose(Switch& contact, const std::string& why, std::vector<ButtonEvent>& edges);

  const Clock& clock_;
  HoldGuard guard_;
  std::vector<Switch> switches_;
  std::optional<std::string> gone_;  ///< lines that no longer answer
};

}  // namespace lumibox::hal
