#pragma once

#include <memory>

#include "config/config.h"
#include "hal/buttons.h"
#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/display.h"
#include "hal/status_led.h"

namespace lumibox::app {

/// The hardware of one box. Members are destroyed from the last to the first: the clock, which the
/// others refer to, goes last.
struct Devices {
  std::unique_ptr<hal::Clock> clock;
  std::unique_ptr<hal::Camera> camera;
  std::unique_ptr<hal::Buttons> buttons;
  std::unique_ptr<hal::Display> display;
  std::unique_ptr<hal::StatusLed> status_led;  ///< none: the box has no lamp
  bool lockstep = false;                       ///< time is virtual: nothing may run beside the loop
};

/// The one place where backends are chosen. Opens what `config.devices` names (config.h lists the
/// kinds),
/// the camera started and the display's context current on this thread. Throws config::InputError
/// that names the option, what it says and which kinds this build has.
Devices open_devices(const config::Config& config);

}  // namespace lumibox::app
