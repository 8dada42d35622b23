#include "app/devices.h"

#include <charconv>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/button_script.h"
#include "config/error.h"
#include "hal/evdev/evdev_buttons.h"
#include "hal/gpiod/gpiod_buttons.h"
#include "hal/gpiod/gpiod_led.h"
#include "hal/kms/kms_display.h"
#include "hal/libcamera/libcamera_camera.h"
#include "hal/merged_buttons.h"
#include "hal/offscreen/offscreen_display.h"
#include "hal/replay/replay_camera.h"
#include "hal/scripted/scripted_buttons.h"
#include "hal/sim/scene.h"
#include "hal/sim/sim_camera.h"
#include "hal/sim/virtual_clock.h"
#include "hal/system_clock.h"
#include "hal/v4l2/v4l2_camera.h"
#include "hal/window/window_buttons.h"
#include "hal/window/window_display.h"

namespace lumibox::app {
namespace {

/// A device as the configuration names it: "kind" or "kind:what".
struct Name {
  std::string kind;
  std::string what;
};

Name split(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    return {text, {}};
  }
  return {text.substr(0, colon), text.substr(colon + 1)};
}

[[noreturn]] void refuse(const char* option, const std::string& found, const char* kinds) {
  throw config::InputError(std::string("devices.") + option + ": \"" + found +
                           "\" is not in this build; it has " + kinds);
}

/// What stands behind the colon, which must be something.
const std::string& what_of(const Name& name, const char* option, const char* expected) {
  if (name.what.empty()) {
    throw config::InputError(std::string("devices.") + option + ": \"" + name.kind +
                             "\" without a name; expected " + expected);
  }
  return name.what;
}

std::unique_ptr<hal::Clock> open_clock(const std::string& text) {
  if (text == "system") {
    return std::make_unique<hal::SystemClock>();
  }
  if (text == "virtual") {
    return std::make_unique<hal::VirtualClock>();
  }
  refuse("clock", text, "system and virtual");
}

/// Frames of a real camera come in real time.
template <typename RealCamera>
std::unique_ptr<hal::Camera> open_real_camera(const std::string& device,
                                              const config::Config& config,
                                              const hal::Clock& clock) {
  if (config.devices.clock != "system") {
    throw config::InputError("devices.clock: \"" + config.devices.clock +
                             "\" with a real camera; expected \"system\"");
  }
  hal::CameraOptions options{device, std::nullopt, config.camera};
  if (!config.devices.calibration.empty()) {
    options.calibration = hal::read_calibration(config.devices.calibration);
  }
  return std::make_unique<RealCamera>(options, clock);
}

std::unique_ptr<hal::Camera> open_camera(const config::Config& config, const hal::Clock& clock) {
  const std::string& text = config.devices.camera;
  const std::string& calibration = config.devices.calibration;
  if (text.empty()) {
    throw config::InputError(
        "devices.camera is not set; expected v4l2:DEVICE, libcamera, sim:SCENE.toml or "
        "replay:SEQUENCE, in a --config file or with --set devices.camera=...");
  }
  const Name name = split(text);
  if (name.kind == "v4l2") {
    return open_real_camera<hal::V4l2Camera>(
        what_of(name, "camera", "v4l2:auto or v4l2:/dev/video0"), config, clock);
  }
  if (text == "libcamera") {
    return open_real_camera<hal::LibcameraCamera>("auto", config, clock);
  }
  if (name.kind == "libcamera") {
    return open_real_camera<hal::LibcameraCamera>(
        what_of(name, "camera", "libcamera, libcamera:auto or libcamera:0"), config, clock);
  }
  if (name.kind == "sim") {
    if (!calibration.empty()) {
      throw config::InputError("devices.calibration: \"" + calibration +
                               "\" with a simulated camera, which has its own; expected none");
    }
    return std::make_unique<hal::SimCamera>(
        hal::load_scene(what_of(name, "camera", "sim:SCENE.toml")), clock);
  }
  if (name.kind == "replay") {
    return std::make_unique<hal::ReplayCamera>(
        hal::open_sequence(
            what_of(name, "camera", "replay:SEQUENCE"),
            calibration.empty() ? std::nullopt : std::optional<std::filesystem::path>(calibration)),
        clock, hal::Pacing::Recorded);
  }
  refuse("camera", text,
         "v4l2:DEVICE, libcamera, libcamera:CAMERA, sim:SCENE.toml and replay:SEQUENCE");
}

/// Buttons that a hand presses go by the system's time.
void refuse_virtual_clock(const std::string& kind, const config::Config& config) {
  if (config.devices.clock == "virtual") {
    throw config::InputError("devices.buttons: \"" + kind +
                             "\" with devices.clock = \"virtual\", which no hand keeps up with; "
                             "expected \"system\"");
  }
}

/// What is typed into the window of the display.
std::unique_ptr<hal::Buttons> open_window_buttons(const config::Config& config,
                                                  const hal::Clock& clock,
                                                  const std::shared_ptr<hal::KeyEdges>& keys) {
  refuse_virtual_clock("window", config);
  if (split(config.devices.display).kind != "window") {
    throw config::InputError("devices.buttons: \"window\" with devices.display = \"" +
                             config.devices.display + "\"; expected \"window\" there too");
  }
  return std::make_unique<hal::WindowButtons>(keys, config.evdev, config.controls.stuck_s, clock);
}

std::unique_ptr<hal::Buttons> open_buttons_of(const std::string& text, const config::Config& config,
                                              const hal::Clock& clock,
                                              const std::shared_ptr<hal::KeyEdges>& keys) {
  const Name name = split(text);
  const config::Controls& controls = config.controls;
  if (name.kind == "script") {
    return std::make_unique<hal::ScriptedButtons>(
        read_button_script(what_of(name, "buttons", "script:FILE"), controls.long_press_s), clock);
  }
  if (text == "gpio") {
    refuse_virtual_clock(name.kind, config);
    return std::make_unique<hal::GpiodButtons>(config.gpio, controls.stuck_s, clock);
  }
  if (name.kind == "evdev") {
    const std::string& wanted =
        what_of(name, "buttons", "evdev:any, evdev:/dev/input/... or evdev:NAME");
    refuse_virtual_clock(name.kind, config);
    return std::make_unique<hal::EvdevButtons>(wanted, config.evdev, controls.stuck_s, clock);
  }
  if (text == "window") {
    return open_window_buttons(config, clock, keys);
  }
  if (text == "none") {
    return std::make_unique<hal::ScriptedButtons>(std::vector<hal::ButtonEvent>{}, clock);
  }
  refuse("buttons", text, "none, gpio, evdev:any, evdev:PATH, evdev:NAME, window and script:FILE");
}

/// One kind, or several with commas between.
std::unique_ptr<hal::Buttons> open_buttons(const config::Config& config, const hal::Clock& clock,
                                           const std::shared_ptr<hal::KeyEdges>& keys) {
  std::vector<std::unique_ptr<hal::Buttons>> sources;
  std::istringstream kinds(config.devices.buttons + ",");
  for (std::string kind; std::getline(kinds >> std::ws, kind, ',');) {
    kind.erase(kind.find_last_not_of(' ') + 1);
    if (kind.empty()) {
      throw config::InputError("devices.buttons: \"" + config.devices.buttons +
                               "\" names nothing before or after a comma; expected e.g. none, or "
                               "gpio, evdev:any");
    }
    sources.push_back(open_buttons_of(kind, config, clock, keys));
  }
  return std::make_unique<hal::MergedButtons>(std::move(sources));
}

std::unique_ptr<hal::StatusLed> open_status_led(const config::Config& config) {
  const std::string& text = config.devices.status_led;
  const Name name = split(text);
  if (text == "none") {
    return nullptr;
  }
  if (name.kind == "gpio") {
    return std::make_unique<hal::GpiodLed>(what_of(name, "status_led", "gpio:LINE"),
                                           config.gpio.led_active_low);
  }
  refuse("status_led", text, "none and gpio:LINE");
}

/// "640x480"
std::optional<std::pair<int, int>> parse_size(std::string_view text) {
  constexpr int kLargest = 8192;
  std::pair<int, int> size;
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.first);
  if (width.ec != std::errc() || width.ptr == end || *width.ptr != 'x') {
    return std::nullopt;
  }
  const auto height = std::from_chars(width.ptr + 1, end, size.second);
  const bool fits = size.first >= 1 && size.first <= kLargest &&  //
                    size.second >= 1 && size.second <= kLargest;
  if (height.ec != std::errc() || height.ptr != end || !fits) {
    return std::nullopt;
  }
  return size;
}

std::unique_ptr<hal::Display> open_screen(const std::string& card, const config::Display& options,
                                          const hal::Clock& clock) {
  hal::KmsOptions kms{card, std::nullopt, *hal::kms::rotation_of(options.rotation_deg)};
  if (!options.mode.empty()) {
    kms.mode = hal::kms::parse_mode_wish(options.mode);
    if (!kms.mode) {
      throw config::InputError("display.mode: \"" + options.mode +
                               "\" is no mode; expected e.g. 1280x720 or 1280x720@60");
    }
  }
  return std::make_unique<hal::KmsDisplay>(kms, clock);
}

/// "offscreen:640x480" or "window:640x480"; a window without a size has that.
std::pair<int, int> size_of(const Name& name) {
  if (name.kind == "window" && name.what.empty()) {
    return {640, 480};
  }
  const auto size = parse_size(name.what);
  if (!size) {
    throw config::InputError("devices.display: \"" + name.kind + ":" + name.what +
                             "\" has no size; expected e.g. " + name.kind + ":640x480");
  }
  return *size;
}

std::unique_ptr<hal::Display> open_display(const config::Config& config, const hal::Clock& clock,
                                           const std::shared_ptr<hal::KeyEdges>& keys) {
  const std::string& text = config.devices.display;
  const Name name = split(text);
  if (name.kind == "kms") {
    return open_screen(name.what, config.display, clock);
  }
  if (name.kind != "offscreen" && name.kind != "window") {
    refuse("display", text,
           "kms, kms:CARD, window, window:WIDTHxHEIGHT and offscreen:WIDTHxHEIGHT");
  }
  const auto [width, height] = size_of(name);
  if (name.kind == "window") {
    return std::make_unique<hal::WindowDisplay>(width, height, keys, clock);
  }
  return std::make_unique<hal::OffscreenDisplay>(width, height);
}

}  // namespace

Devices open_devices(const config::Config& config) {
  const config::Devices& options = config.devices;
  Devices devices;
  devices.clock = open_clock(options.clock);
  devices.lockstep = options.clock == "virtual";
  const auto keys = std::make_shared<hal::KeyEdges>();  // kept by who listens to them
  devices.buttons = open_buttons(config, *devices.clock, keys);
  devices.status_led = open_status_led(config);
  const hal::Clock& clock = *devices.clock;
  devices.open_camera = [config, &clock] { return open_camera(config, clock); };
  devices.open_display = [config, &clock, heard = std::weak_ptr(keys)] {
    auto display = open_display(config, clock, heard.lock());
    display->make_current();
    return display;
  };
  open_missing(devices);
  if (devices.lockstep && !devices.missing.empty()) throw config::Unavailable(devices.missing);
  return devices;
}

void open_missing(Devices& devices) {
  devices.missing.clear();
  const auto attempt = [&devices](const std::function<void()>& step) {
    try {
      step();
    } catch (const config::Unavailable& fault) {
      devices.missing += (devices.missing.empty() ? "" : "; ") + std::string(fault.what());
    }
  };
  attempt([&] {
    if (!devices.camera) devices.camera = devices.open_camera();
  });
  attempt([&] {
    if (!devices.display) devices.display = devices.open_display();
  });
  if (!devices.missing.empty()) return;
  attempt([&] {
    if (devices.camera->state() == hal::CameraState::Stopped) devices.camera->start();
  });
  if (!devices.missing.empty()) devices.camera.reset();
}

}  // namespace lumibox::app
