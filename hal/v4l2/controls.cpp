#include "hal/v4l2/controls.h"

#include <fmt/core.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <iterator>

#include "config/error_text.h"
#include "hal/v4l2/modes.h"

namespace lumibox::hal::v4l2 {
namespace {

/// Something that a camera adjusts by itself unless told not to.
struct Automatism {
  std::uint32_t switch_id;
  const char* switch_name;
  std::int32_t manual;  ///< what the switch is set to
  std::uint32_t value_id;
  const char* value_name;
};

// Each switch before its value. Without automatism nothing varies, and nothing need be held.
constexpr Automatism kAutomatisms[] = {
    {V4L2_CID_FOCUS_AUTO, "autofocus", 0, V4L2_CID_FOCUS_ABSOLUTE, "focus"},
    {V4L2_CID_EXPOSURE_AUTO, "automatic exposure", V4L2_EXPOSURE_MANUAL, V4L2_CID_EXPOSURE_ABSOLUTE,
     "exposure"},
    {V4L2_CID_AUTOGAIN, "automatic gain", 0, V4L2_CID_GAIN, "gain"},
    {V4L2_CID_AUTO_WHITE_BALANCE, "automatic white balance", 0, V4L2_CID_WHITE_BALANCE_TEMPERATURE,
     "white balance"},
};

/// A camera with this on lowers its frame rate in the dark.
constexpr Setting kSteadyRate{V4L2_CID_EXPOSURE_AUTO_PRIORITY, "exposure before rate", 0};

constexpr int kTries = 3;

// No camera has as many; a driver that never says that there are no more must not hold us up.
constexpr std::size_t kMostControls = 512;

std::optional<v4l2_queryctrl> query(VideoDevice& device, std::uint32_t id) {
  v4l2_queryctrl control{};
  control.id = id;
  if (device.ioctl(VIDIOC_QUERYCTRL, &control) != 0) return std::nullopt;
  if ((control.flags & V4L2_CTRL_FLAG_DISABLED) != 0) return std::nullopt;
  return control;
}

std::optional<std::int32_t> read(VideoDevice& device, std::uint32_t id) {
  v4l2_control control{id, 0};
  if (device.ioctl(VIDIOC_G_CTRL, &control) != 0) return std::nullopt;
  return control.value;
}

/// The value of a control that can be read and set.
std::optional<std::int32_t> adjustable(VideoDevice& device, std::uint32_t id) {
  const auto control = query(device, id);
  if (!control || (control->flags & V4L2_CTRL_FLAG_READ_ONLY) != 0) return std::nullopt;
  return read(device, id);
}

/// Whether a menu has an entry; what is no menu has all.
bool offers(VideoDevice& device, std::uint32_t id, std::int32_t value) {
  const auto control = query(device, id);
  if (!control || control->type != V4L2_CTRL_TYPE_MENU) return control.has_value();
  v4l2_querymenu entry{};
  entry.id = id;
  entry.index = static_cast<std::uint32_t>(value);
  return device.ioctl(VIDIOC_QUERYMENU, &entry) == 0;
}

/// The reason why a control does not have its value in the end.
std::optional<std::string> set(VideoDevice& device, const Setting& setting) {
  std::string reason;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    v4l2_control control{setting.id, setting.value};
    const int error = device.ioctl(VIDIOC_S_CTRL, &control);
    const std::optional<std::int32_t> now = read(device, setting.id);
    if (error == 0 && now == setting.value) return std::nullopt;
    reason = error != 0 ? config::error_text(error)
             : now      ? fmt::format("it is {}", *now)
                        : "it cannot be read back";
  }
  return fmt::format("{} is not set to {}: {}", setting.name, setting.value, reason);
}

bool is_listed(const v4l2_queryctrl& control) {
  return (control.flags & V4L2_CTRL_FLAG_DISABLED) == 0 &&
         (control.type == V4L2_CTRL_TYPE_INTEGER || control.type == V4L2_CTRL_TYPE_BOOLEAN ||
          control.type == V4L2_CTRL_TYPE_MENU);
}

}  // namespace

std::vector<Control> list_controls(VideoDevice& device) {
  std::vector<Control> controls;
  std::uint32_t last = 0;
  for (std::size_t i = 0; i < kMostControls; ++i) {
    v4l2_queryctrl control{};
    control.id = last | V4L2_CTRL_FLAG_NEXT_CTRL;
    if (device.ioctl(VIDIOC_QUERYCTRL, &control) != 0 || control.id <= last) break;
    last = control.id;
    const auto value = is_listed(control) ? read(device, control.id) : std::nullopt;
    if (!value) continue;
    const auto* name = reinterpret_cast<const char*>(control.name);
    const auto* end = std::find(name, name + sizeof control.name, '\0');
    controls.push_back(
        {control.id, std::string(name, end), control.minimum, control.maximum, *value});
  }
  return controls;
}

std::vector<std::string> set_controls(VideoDevice& device, const std::vector<Setting>& settings) {
  std::vector<std::string> faults;
  for (const Setting& setting : settings) {
    if (auto fault = set(device, setting)) faults.push_back(*std::move(fault));
  }
  return faults;
}

Automatic make_automatic(VideoDevice& device) {
  Automatic result;
  const auto reset = [&](std::uint32_t id, const char* name) {
    const auto now = adjustable(device, id);
    const auto control = query(device, id);
    if (!now || !control || *now == control->default_value) return;
    if (auto fault = set(device, {id, name, control->default_value})) {
      result.faults.push_back(*std::move(fault));
    } else {
      result.switched.emplace_back(name);
    }
  };
  for (const Automatism& row : kAutomatisms) {
    // Who calibrated the camera may have fixed the focus on purpose: it is never set loose.
    if (row.switch_id != V4L2_CID_FOCUS_AUTO) reset(row.switch_id, row.switch_name);
  }
  reset(kSteadyRate.id, kSteadyRate.name);
  return result;
}

std::vector<std::string> ExposureHold::hold(VideoDevice& device) {
  if (holds()) return set_controls(device, held_);
  // All are read before the first is set: without its automatism a value may already be another.
  for (const Automatism& row : kAutomatisms) {
    const auto automatic = adjustable(device, row.switch_id);
    if (!automatic || !offers(device, row.switch_id, row.manual)) continue;
    before_.push_back({row.switch_id, row.switch_name, *automatic});
    held_.push_back({row.switch_id, row.switch_name, row.manual});
    if (const auto value = adjustable(device, row.value_id)) {
      held_.push_back({row.value_id, row.value_name, *value});
    }
  }
  if (const auto priority = adjustable(device, kSteadyRate.id)) {
    before_.push_back({kSteadyRate.id, kSteadyRate.name, *priority});
    held_.push_back(kSteadyRate);
  }
  return set_controls(device, held_);
}

std::vector<std::string> ExposureHold::free(VideoDevice& device) {
  const std::vector<Setting> before = std::move(before_);
  before_.clear();
  held_.clear();
  return set_controls(device, before);
}

std::string ExposureHold::description() const {
  std::string text;
  for (const Automatism& row : kAutomatisms) {
    const auto value = std::ranges::find(held_, row.value_id, &Setting::id);
    if (value == held_.end()) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", row.value_name, value->value);
  }
  return text.empty() ? "nothing" : text;
}

std::optional<Setting> power_line_setting(const std::string& name) {
  constexpr const char* kNames[] = {"off", "50hz", "60hz", "auto"};  // in V4L2's order from 0
  const auto* found = std::ranges::find(kNames, name);
  if (found == std::end(kNames)) return std::nullopt;
  return Setting{V4L2_CID_POWER_LINE_FREQUENCY, "power line frequency",
                 static_cast<std::int32_t>(found - kNames)};
}

}  // namespace lumibox::hal::v4l2
