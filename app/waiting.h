#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/devices.h"
#include "app/picture.h"
#include "app/screen.h"
#include "config/config.h"

namespace lumibox::app {

/// A box that has been switched on without its camera or its screen: looks for them, and says on
/// the screen, as soon as there is one, what it waits for and why.
class Waiting {
 public:
  /// `devices` must outlive the object; only the camera and the display may be missing.
  Waiting(Devices& devices, const config::Config& config);

  /// Has this shown among the alerts of every picture.
  void always_show(std::string alert) { standing_alerts_.push_back(std::move(alert)); }

  /// Whether the box has both.
  bool over() const { return devices_.missing.empty(); }

  /// Looks again, once a second, and shows a picture. Throws as open_missing() does.
  void tick();

  /// What is on the screen, or would be.
  const Picture& picture() const { return picture_; }

  /// hal::Display's; without a display those that nobody could see, one in each tick.
  std::int64_t presented() const;

 private:
  void look_again();
  void show();
  void say();

  Devices& devices_;
  config::Render options_;
  std::optional<Screen> screen_;
  Picture picture_;
  std::vector<std::string> standing_alerts_;
  std::int64_t look_again_ns_;
  std::int64_t unseen_ = 0;
};

}  // namespace lumibox::app
