#include "hal/system_clock.h"

#include <gtest/gtest.h>

#include <limits>

namespace lumibox::hal {
namespace {

TEST(SystemClock, NeverGoesBack) {
  const SystemClock clock;
  std::int64_t before = clock.now_ns();
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t now = clock.now_ns();
    EXPECT_GE(now, before);
    before = now;
  }
}

TEST(SystemClock, IsAtTheDeadlineAfterWaitingForIt) {
  SystemClock clock;
  for (const std::int64_t ahead_ns : {1, 1000, 1'000'000}) {
    const std::int64_t deadline_ns = clock.now_ns() + ahead_ns;
    clock.wait_until(deadline_ns);
    EXPECT_GE(clock.now_ns(), deadline_ns);
  }
}

// A past deadline must not disarm the timer and wait for ever.
TEST(SystemClock, ReturnsAtOnceFromADeadlineInThePast) {
  SystemClock clock;
  for (const std::int64_t deadline_ns :
       {std::numeric_limits<std::int64_t>::min(), std::int64_t{0}, clock.now_ns()}) {
    clock.wait_until(deadline_ns);
  }
}

}  // namespace
}  // namespace lumibox::hal
