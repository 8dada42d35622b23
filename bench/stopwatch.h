#pragma once

#include <chrono>
#include <ctime>

namespace lumibox::bench {

/// Processor time spent so far, of the calling thread alone or of the whole program. Other programs
/// on the machine disturb it little.
inline double cpu_ms(clockid_t of) {
  std::timespec now{};
  clock_gettime(of, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

inline double program_cpu_ms() {
  return cpu_ms(CLOCK_PROCESS_CPUTIME_ID);
}

/// Time by the clock on the wall and by the processor since it was made: of the calling thread, or
/// with CLOCK_PROCESS_CPUTIME_ID of the whole program, whose threads' times add up.
class Stopwatch {
 public:
  explicit Stopwatch(clockid_t cpu_of = CLOCK_THREAD_CPUTIME_ID) : cpu_of_(cpu_of) {}

  double wall_ms() const {
    return std::chrono::duration<double, std::milli>(Wall::now() - wall_begin_).count();
  }
  double cpu_ms() const { return bench::cpu_ms(cpu_of_) - cpu_begin_ms_; }

 private:
  using Wall = std::chrono::steady_clock;
  clockid_t cpu_of_;
  Wall::time_point wall_begin_ = Wall::now();
  double cpu_begin_ms_ = bench::cpu_ms(cpu_of_);
};

}  // namespace lumibox::bench
