#include "app/demo.h"

#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "app/button_script.h"
#include "app/demo_quality.h"
#include "app/loop.h"
#include "app/scenes.h"
#include "config/error.h"
#include "hal/image_io.h"
#include "hal/offscreen/offscreen_display.h"
#include "hal/scripted/scripted_buttons.h"
#include "hal/sim/sim_camera.h"
#include "hal/sim/virtual_clock.h"

namespace lumibox::app {
namespace {

using hal::Button;

/// Something that happens in the demo: a picture of the screen, a press, or both, in this order.
struct Step {
  double time_s;
  std::optional<Gesture> press;
  const char* picture;  ///< file name without .png; null for none
  const char* says;
};

constexpr Gesture kMain{Button::Main, Press::Short};
constexpr Gesture kMainLong{Button::Main, Press::Long};
constexpr Gesture kReview{Button::Review, Press::Short};
constexpr Gesture kPlus{Button::Plus, Press::Short};
constexpr Gesture kMinus{Button::Minus, Press::Short};
constexpr Gesture kPlusLong{Button::Plus, Press::Long};
constexpr Gesture kWipe{Button::Wipe, Press::Short};
constexpr Gesture kWipeLong{Button::Wipe, Press::Long};

// The walk of the scene takes 21.5 seconds; after it the box has nothing new to see.
constexpr Step kSteps[] = {
    {0.0, kMain, "01-looking-around", "Main: nothing to place yet, so nothing happens"},
    {1.6, kReview, "02-aim", "Review, since there is a map: the augmented aperture"},
    {2.3, kMinus, "03-focus", "-: focus nearer"},
    {2.5, kMinus, nullptr, "-: nearer still"},
    {2.9, kPlus, "04-focused-nearer", "+: and back"},
    {3.1, kPlus, nullptr, "+: to where it was sharp"},
    {3.5, kMain, nullptr, "Main: the sphere stays where the focus is"},
    {3.9, kMain, "05-placed", "Main: the capture begins"},
    {6.0, std::nullopt, "06-capture-early", "painting the sphere"},
    {8.0, kWipe, nullptr, "Wipe: the nearest view is removed, and recording pauses"},
    {8.2, kWipeLong, nullptr, "Wipe, long: it comes back"},
    {9.0, kMain, nullptr, "Main: recording goes on"},
    {13.0, std::nullopt, "07-capture-middle", "painting the sphere"},
    {15.0, kReview, nullptr, "Review: at once, from where the box is"},
    {15.2, kReview, "08-review-on-the-way", "Review: back to the capture"},
    {21.4, kReview, "09-capture-late", "Review, since the walk ends"},
    {21.6, kMainLong, nullptr, "Main, long: a slow orbit in place of the box"},
    {24.0, kMain, "10-review-small-aperture", "Main: the wide aperture"},
    {24.3, kMinus, "11-review-wide-aperture", "-: focus nearer"},
    {24.5, kMinus, nullptr, "-: nearer still"},
    {24.8, kPlusLong, "12-focus-near", "+, long: focus farther"},
    {25.7, std::nullopt, "13-focus-far", "the end"},
};

std::vector<hal::ButtonEvent> presses(double long_press_s) {
  std::vector<hal::ButtonEvent> events;
  for (const Step& step : kSteps) {
    if (step.press) {
      for (const hal::ButtonEvent& event : press_at(step.time_s, *step.press, long_press_s)) {
        events.push_back(event);
      }
    }
  }
  return events;
}

/// Follows the steps: says each when its time has come and takes its picture.
class Narrator {
 public:
  Narrator(std::filesystem::path out, const hal::OffscreenDisplay& display)
      : out_(std::move(out)), display_(display) {}

  /// After a tick; false when all is told.
  bool tell(std::int64_t now_ns) {
    const double now_s = 1e-9 * static_cast<double>(now_ns);
    for (; next_ < std::size(kSteps) && kSteps[next_].time_s <= now_s; ++next_) {
      const Step& step = kSteps[next_];
      std::printf("%5.1f s  ", step.time_s);
      if (step.picture != nullptr) {
        const auto file = out_ / (std::string(step.picture) + ".png");
        hal::write_png(file, display_.read_back());
        std::printf("%s\n         %s", file.c_str(), step.press ? "then " : "");
      }
      std::printf("%s\n", step.says);
      std::fflush(stdout);
    }
    return next_ < std::size(kSteps);
  }

 private:
  std::filesystem::path out_;
  const hal::OffscreenDisplay& display_;
  std::size_t next_ = 0;
};

}  // namespace

void run_demo(const config::Config& config, const std::filesystem::path& out) {
  const auto scene = hal::load_scene(find_scene("toy"));
  Devices devices;
  devices.clock = std::make_unique<hal::VirtualClock>();
  devices.camera = std::make_unique<hal::SimCamera>(scene, *devices.clock);
  devices.buttons =
      std::make_unique<hal::ScriptedButtons>(presses(config.controls.long_press_s), *devices.clock);
  auto offscreen = std::make_unique<hal::OffscreenDisplay>(640, 480);
  const hal::OffscreenDisplay& display = *offscreen;
  devices.display = std::move(offscreen);
  devices.display->make_current();
  devices.camera->start();

  Loop loop(devices, config, out, kLockstep);
  Narrator narrator(out, display);
  loop.run_and_finish([&] { return narrator.tell(devices.clock->now_ns()); });
  say_quality(*scene, loop);
  devices.display->make_current();  // for the loop's end
}

}  // namespace lumibox::app
