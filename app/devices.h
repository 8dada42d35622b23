#pragma once

#include <functional>
#include <memory>
#include <string>

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
  std::unique_ptr<hal::Camera> camera;  ///< none, or not started, while anything is missing
  std::unique_ptr<hal::Buttons> buttons;
  std::unique_ptr<hal::Display> display;       ///< none while it is missing
  std::unique_ptr<hal::StatusLed> status_led;  ///< none: the box has no lamp
  std::function<std::unique_ptr<hal::Camera>()> open_camera;
  std::function<std::unique_ptr<hal::Display>()> open_display;
  std::string missing;    ///< why there is no camera or screen; empty if there are both
  bool lockstep = false;  ///< time is virtual: nothing may run beside the loop
};

/// The one place where backends are chosen. Opens what `config.devices` names (config.h lists the
/// kinds), the camera started and the display's context current on this thread. Throws
/// config::InputError that names the option, what it says and which kinds this build has. A camera
/// or screen that is not there is `missing`; where time is virtual nothing can come, and it is
/// thrown.
Devices open_devices(const config::Config& config);

/// Opens what is still missing, if it is there now. Throws config::InputError if what came cannot
/// be used whoever waits.
void open_missing(Devices& devices);

}  // namespace lumibox::app
