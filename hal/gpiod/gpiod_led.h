#pragma once

#include <string>

#include "hal/gpiod/gpio_line.h"
#include "hal/status_led.h"

namespace lumibox::hal {

/// A lamp on a line of the board.
class GpiodLed : public StatusLed {
 public:
  /// `line` is NAME or CHIP:OFFSET. Throws config::InputError if it cannot be had.
  GpiodLed(const std::string& line, bool active_low)
      : line_({.option = "devices.status_led", .line = line, .active_low = active_low}) {}

  void light(bool lit) override { line_.set(lit); }

 private:
  GpioOutput line_;
};

}  // namespace lumibox::hal
