#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/evdev/held_keys.h"
#include "hal/evdev/key_map.h"
#include "hal/hold_guard.h"
#include "hal/owned.h"

struct libevdev;

namespace lumibox::hal {

/// How a device is taken.
struct EvdevTerms {
  KeyMap keys;
  std::string name;  ///< that the device must have; empty: any
  bool grab = false;
  double stuck_s = 0.0;
};

/// A keyboard, a remote or the like that is plugged in, until it is unplugged.
class EvdevDevice {
 public:
  /// What came of opening one: a device; or why it cannot be had; or neither, if it has another
  /// name or none of the keys.
  struct Opened {
    std::unique_ptr<EvdevDevice> device;
    std::string refusal;
  };
  static Opened open(const std::filesystem::path& path, const EvdevTerms& terms,
                     std::int64_t now_ns);

  std::string name() const;

  /// Edges since the last call, oldest first; those of each button alternate. When the device has
  /// gone, its buttons are released.
  std::vector<ButtonEvent> poll(std::int64_t now_ns);

  bool gone() const { return gone_; }
  std::optional<std::string> error() const { return guard_.error(); }

 private:
  struct Free {
    void operator()(libevdev* device) const;
  };

  EvdevDevice(File file, const EvdevTerms& terms);

  /// Finds out which keys are down before anybody has pressed them here.
  void begin(std::int64_t now_ns);
  bool read(std::int64_t now_ns, std::vector<ButtonEvent>& edges);

  File file_;
  std::unique_ptr<libevdev, Free> device_;
  KeyMap keys_;
  HeldKeys held_;
  HoldGuard guard_;
  bool gone_ = false;
};

}  // namespace lumibox::hal
