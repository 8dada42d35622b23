#include "hal/evdev/evdev_buttons.h"

#include <sys/stat.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "config/error.h"
#include "config/log.h"
#include "hal/device_files.h"

namespace lumibox::hal {
namespace {

/// Between two looks for devices: nobody waits longer after plugging one in, and a look at a folder
/// of a dozen files costs nothing.
constexpr std::int64_t kLookAgainNs = 1'000'000'000;

}  // namespace

EvdevButtons::EvdevButtons(std::string wanted, const config::Evdev& options, double stuck_s,
                           const Clock& clock, std::filesystem::path folder)
    : wanted_(std::move(wanted)),
      folder_(std::move(folder)),
      terms_{key_map(options), wants_any() || wants_path() ? "" : wanted_, options.grab, stuck_s},
      clock_(clock) {
  const std::optional<std::string> refusal = look(clock_.now_ns());
  if (devices_.empty() && refusal) {
    throw config::InputError("devices.buttons: evdev:" + wanted_ + ": " + *refusal);
  }
  if (const auto missing = missing_device()) config::log_warning("buttons: " + *missing);
}

std::vector<ButtonEvent> EvdevButtons::poll() {
  const std::int64_t now_ns = clock_.now_ns();
  std::vector<ButtonEvent> edges;
  for (const auto& [path, device] : devices_) {
    const std::vector<ButtonEvent> more = device->poll(now_ns);
    edges.insert(edges.end(), more.begin(), more.end());
  }
  drop_gone(now_ns);
  if (now_ns >= look_again_ns_) {
    if (const auto refusal = look(now_ns)) {
      config::log_warning("buttons: " + *refusal);
    }
  }
  return union_.merge(std::move(edges));
}

void EvdevButtons::drop_gone(std::int64_t now_ns) {
  std::erase_if(devices_, [&](const auto& entry) {
    if (entry.second->gone()) {
      config::log_warning("buttons: " + entry.second->name() + " is gone");
      look_again_ns_ = now_ns + kLookAgainNs;  // its file may still be there
    }
    return entry.second->gone();
  });
}

std::optional<std::string> EvdevButtons::error() const {
  std::vector<std::optional<std::string>> errors;
  errors.push_back(missing_device());
  for (const auto& [path, device] : devices_) errors.push_back(device->error());
  return joined(errors);
}

std::optional<std::string> EvdevButtons::missing_device() const {
  if (!devices_.empty() || wants_any()) return std::nullopt;
  return wanted_ + " is not there; waiting for it";
}

/// Takes what is new and wanted; why something cannot be had, if that is news.
std::optional<std::string> EvdevButtons::look(std::int64_t now_ns) {
  look_again_ns_ = now_ns + kLookAgainNs;
  std::optional<std::string> news;
  for (const std::filesystem::path& path : candidates()) {
    const std::optional<Identity> identity = identity_of(path);
    const auto other = others_.find(path);
    const bool is_other = other != others_.end() && other->second == identity;
    if (!identity || is_other || devices_.contains(path)) {
      continue;
    }
    const std::string refusal = try_to_open(path, *identity, now_ns);
    if (refusal != std::exchange(refused_[path], refusal) && !refusal.empty()) {
      news = refusal;
    }
  }
  return news;
}

/// Why the device cannot be had; empty if it has been taken, or is not wanted.
std::string EvdevButtons::try_to_open(const std::filesystem::path& path, const Identity& identity,
                                      std::int64_t now_ns) {
  EvdevDevice::Opened opened = EvdevDevice::open(path, terms_, now_ns);
  if (opened.device) {
    config::log_info("buttons: " + opened.device->name() + " (" + path.string() + ")");
    devices_[path] = std::move(opened.device);
  } else if (opened.refusal.empty()) {
    others_[path] = identity;
    if (wants_path()) {
      return path.string() + ": has none of the keys; expected one at least of those of [evdev]";
    }
  }
  return opened.refusal;
}

std::vector<std::filesystem::path> EvdevButtons::candidates() const {
  if (wants_path()) {
    return {wanted_};
  }
  return device_files(folder_, "event");
}

std::optional<EvdevButtons::Identity> EvdevButtons::identity_of(const std::filesystem::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    return std::nullopt;
  }
  return Identity{status.st_dev, status.st_ino,
                  status.st_ctim.tv_sec * std::int64_t{1'000'000'000} + status.st_ctim.tv_nsec};
}

}  // namespace lumibox::hal
