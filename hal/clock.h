#pragma once

#include <cstdint>

namespace lumibox::hal {

/// The only source of time in the program.
class Clock {
 public:
  virtual ~Clock() = default;

  /// Monotonic, nanoseconds.
  virtual std::int64_t now_ns() const = 0;

  /// Returns at `deadline_ns` or, if that has passed, at once.
  virtual void wait_until(std::int64_t deadline_ns) = 0;
};

}  // namespace lumibox::hal
