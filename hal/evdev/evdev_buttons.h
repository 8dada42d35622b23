#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/config.h"
#include "hal/buttons.h"
#include "hal/clock.h"
#include "hal/evdev/evdev_device.h"
#include "hal/merged_buttons.h"

namespace lumibox::hal {

/// Keys of what Linux knows as input devices: keyboards, remotes, gpio-keys. Devices may come and
/// go: what is wanted is looked for once a second, and a button that is held when its device goes
/// is released.
class EvdevButtons : public Buttons {
 public:
  /// `wanted` is "any", for all devices that have one of the keys; the path of a device; or the
  /// name that one or several have. `clock` runs with CLOCK_MONOTONIC, as SystemClock does. A
  /// device that is not there is waited for. Throws config::InputError for keys that make no sense,
  /// and if what is there cannot be had.
  EvdevButtons(std::string wanted, const config::Evdev& options, double stuck_s, const Clock& clock,
               std::filesystem::path folder = "/dev/input");

  std::vector<ButtonEvent> poll() override;
  std::optional<std::string> error() const override;

 private:
  /// Which file it is; the same name may be another device later.
  struct Identity {
    std::uint64_t device = 0;
    std::uint64_t inode = 0;
    std::int64_t changed_ns = 0;
    bool operator==(const Identity&) const = default;
  };

  bool wants_path() const { return wanted_.starts_with('/'); }
  bool wants_any() const { return wanted_ == "any"; }
  std::vector<std::filesystem::path> candidates() const;
  static std::optional<Identity> identity_of(const std::filesystem::path& path);
  std::optional<std::string> look(std::int64_t now_ns);
  std::string try_to_open(const std::filesystem::path& path, const Identity& identity,
                          std::int64_t now_ns);
  std::optional<std::string> missing_device() const;
  void drop_gone(std::int64_t now_ns);

  std::string wanted_;
  std::filesystem::path folder_;
  EvdevTerms terms_;
  const Clock& clock_;
  std::map<std::filesystem::path, std::unique_ptr<EvdevDevice>> devices_;
  std::map<std::filesystem::path, Identity> others_;      ///< files of devices that are not wanted
  std::map<std::filesystem::path, std::string> refused_;  ///< why wanted ones cannot be had
  std::int64_t look_again_ns_ = 0;
  ButtonUnion union_;
};

}  // namespace lumibox::hal
