#include "hal/system_clock.h"

#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <string>

#include "config/error.h"
#include "config/error_text.h"

namespace lumibox::hal {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

}  // namespace

SystemClock::SystemClock() : timer_(timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC)) {
  if (timer_.descriptor() < 0) {
    throw config::InputError("timerfd: " + config::error_text(errno));
  }
}

std::int64_t SystemClock::now_ns() const {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kNsPerSecond + now.tv_nsec;
}

void SystemClock::wait_until(std::int64_t deadline_ns) {
  if (deadline_ns <= now_ns()) {
    return;  // a time of zero or less would disarm the timer
  }
  itimerspec timer{};
  timer.it_value.tv_sec = deadline_ns / kNsPerSecond;
  timer.it_value.tv_nsec = deadline_ns % kNsPerSecond;
  timerfd_settime(timer_.descriptor(), TFD_TIMER_ABSTIME, &timer, nullptr);
  std::uint64_t expirations = 0;
  while (read(timer_.descriptor(), &expirations, sizeof expirations) < 0 && errno == EINTR) {
  }
}

}  // namespace lumibox::hal
