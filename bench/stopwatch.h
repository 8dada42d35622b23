#pragma once

#include <chrono>
#include <ctime>

#include "geometry/robust.h"

namespace lumibox::bench {

/// Processor time spent so far, of the calling thread alone or of the whole program. Other programs
/// on the machine disturb it little.
inline double cpu_ms(clockid_t of) {
  std::timespec now{};
  clock_gettime(of, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

inline double thread_cpu_ms() {
  return cpu_ms(CLOCK_THREAD_CPUTIME_ID);
}
inline double program_cpu_ms() {
  return cpu_ms(CLOCK_PROCESS_CPUTIME_ID);
}

/// Time by the clock on the wall and by the processor of the calling thread, since it was made.
class Stopwatch {
 public:
  double wall_ms() const {
    return std::chrono::duration<double, std::milli>(Wall::now() - wall_begin_).count();
  }
  double cpu_ms() const { return thread_cpu_ms() - cpu_begin_ms_; }

 private:
  using Wall = std::chrono::steady_clock;
  Wall::time_point wall_begin_ = Wall::now();
  double cpu_begin_ms_ = thread_cpu_ms();
};

}  // namespace lumibox::bench
