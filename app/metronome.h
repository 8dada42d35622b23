#pragma once

#include <cstdint>

#include "hal/clock.h"

namespace lumibox::app {

/// The beat of the loop: absolute deadlines, so that the rate does not drift. When a tick takes
/// longer than its period, the next one begins at once and the beat starts anew from there: what
/// was missed is counted, never replayed in a burst.
class Metronome {
 public:
  Metronome(hal::Clock& clock, double rate_hz);

  /// Returns when the next tick is due.
  void wait();

  std::int64_t due_ns() const { return deadline_ns_ + period_ns_; }  ///< the next tick

  std::int64_t late_ticks() const { return late_ticks_; }

 private:
  hal::Clock& clock_;
  std::int64_t period_ns_;
  std::int64_t deadline_ns_;
  std::int64_t late_ticks_ = 0;
};

}  // namespace lumibox::app
