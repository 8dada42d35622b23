#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/v4l2/video_system.h"

/// What can be adjusted about a camera.
namespace lumibox::hal::v4l2 {

struct Control {
  std::uint32_t id = 0;
  std::string name;  ///< as the driver calls it
  std::int32_t least = 0;
  std::int32_t most = 0;
  std::int32_t value = 0;
};

/// All that are numbers, switches or menus, in the driver's order.
std::vector<Control> list_controls(VideoDevice& device);

/// A value that a control shall have.
struct Setting {
  std::uint32_t id = 0;
  const char* name = "";
  std::int32_t value = 0;
};

/// Sets, reads back and tries again a few times, one control in each call: cameras refuse a focus
/// while their autofocus is on. Says in words what could not be set.
std::vector<std::string> set_controls(VideoDevice& device, const std::vector<Setting>& settings);

/// Switches on what a camera does by itself, as far as its driver has it on by default: who had the
/// camera before may have ended while it held that, as this program does in a crash.
struct Automatic {
  std::vector<std::string> switched;  ///< names of what was not as by default
  std::vector<std::string> faults;    ///< in words, what could not be set
};
Automatic make_automatic(VideoDevice& device);

/// Holds focus, exposure and white balance as they are, so that pictures of one subject match. What
/// a camera does not have is left out.
class ExposureHold {
 public:
  bool holds() const { return !held_.empty(); }

  /// Holds what the camera does now; if something is held already, just that, as after the device
  /// was opened anew. Says what could not be set.
  std::vector<std::string> hold(VideoDevice& device);

  /// Gives back to the camera what it adjusted by itself before. Says what could not be set.
  std::vector<std::string> free(VideoDevice& device);

  /// "focus 40, exposure 156"; "nothing" of a camera that has nothing to be held.
  std::string description() const;

 private:
  std::vector<Setting> held_;
  std::vector<Setting> before_;
};

/// Against lights that flicker: "off", "50hz", "60hz" or "auto". None for anything else.
std::optional<Setting> power_line_setting(const std::string& name);

}  // namespace lumibox::hal::v4l2
