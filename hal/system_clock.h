#pragma once

#include "hal/clock.h"

namespace lumibox::hal {

/// CLOCK_MONOTONIC; waits on an absolute timerfd.
class SystemClock : public Clock {
 public:
  SystemClock();  ///< throws config::InputError if the kernel gives no timer
  ~SystemClock() override;
  SystemClock(const SystemClock&) = delete;
  SystemClock& operator=(const SystemClock&) = delete;

  std::int64_t now_ns() const override;
  void wait_until(std::int64_t deadline_ns) override;

 private:
  int timer_fd_ = -1;
};

}  // namespace lumibox::hal
