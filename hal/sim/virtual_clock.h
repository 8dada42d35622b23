#pragma once

#include <algorithm>

#include "hal/clock.h"

namespace lumibox::hal {

/// Time that passes only when somebody waits: runs take no longer than their work and are the same
/// to the bit.
class VirtualClock : public Clock {
 public:
  std::int64_t now_ns() const override { return now_ns_; }
  void wait_until(std::int64_t deadline_ns) override { now_ns_ = std::max(now_ns_, deadline_ns); }

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace lumibox::hal
