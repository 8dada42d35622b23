#pragma once

#include "app/moment.h"
#include "hal/camera.h"
#include "hal/clock.h"
#include "tracking/tracker.h"

namespace lumibox::app {

/// The map of a tracker, which must outlive the result.
MapNow map_of(const tracking::Tracker& tracker);

/// What the box sees: the camera's newest frame, tracked.
class Sight {
 public:
  /// All must outlive the object.
  Sight(hal::Camera& camera, const hal::Clock& clock, tracking::Tracker& tracker);

  /// Takes the newest frame and tracks it. Without a new one the moment before stays, but for the
  /// time and the map.
  const Moment& look();

  const Moment& moment() const { return moment_; }

 private:
  hal::Camera& camera_;
  const hal::Clock& clock_;
  tracking::Tracker& tracker_;
  Moment moment_;
};

}  // namespace lumibox::app
