#include "app/metronome.h"

#include <cmath>

namespace lumibox::app {

Metronome::Metronome(hal::Clock& clock, double rate_hz)
    : clock_(clock),
      period_ns_(static_cast<std::int64_t>(std::llround(1e9 / rate_hz))),
      deadline_ns_(clock.now_ns()) {}

void Metronome::wait() {
  deadline_ns_ += period_ns_;
  const std::int64_t now_ns = clock_.now_ns();
  if (now_ns > deadline_ns_) {
    ++late_ticks_;
    deadline_ns_ = now_ns;
  }
  clock_.wait_until(deadline_ns_);
}

}  // namespace lumibox::app
