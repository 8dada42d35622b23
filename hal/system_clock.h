#pragma once

#include "hal/clock.h"
#include "hal/owned.h"

namespace lumibox::hal {

/// CLOCK_MONOTONIC; waits on an absolute timerfd.
class SystemClock : public Clock {
 public:
  SystemClock();  ///< throws config::InputError if the kernel gives no timer

  std::int64_t now_ns() const override;
  void wait_until(std::int64_t deadline_ns) override;

 private:
  File timer_;
};

}  // namespace lumibox::hal
