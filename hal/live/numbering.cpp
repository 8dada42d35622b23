#include "hal/live/numbering.h"

#include <algorithm>

namespace lumibox::hal::live {

std::int64_t Numbering::next(std::uint32_t sequence) {
  // Of 32 bits, which wrap around. A step back, and drivers that do not count, are one step.
  constexpr std::uint32_t kBack = 1U << 31;
  const std::uint32_t step = last_sequence_ ? sequence - *last_sequence_ : 1;
  const std::int64_t advance = step == 0 || step >= kBack ? 1 : std::int64_t{step};
  last_sequence_ = sequence;
  missed_ = advance - 1;
  last_ += advance;
  return last_;
}

std::int64_t Stamping::stamp(const Filled& filled, std::int64_t now_ns) {
  // A buffer may have been filled a moment after `now` was read.
  constexpr std::int64_t kSlackNs = 100'000'000;
  replaced_ = !filled.monotonic || filled.timestamp_ns > now_ns + kSlackNs;
  std::int64_t stamp_ns = replaced_ ? now_ns : filled.timestamp_ns;
  stamp_ns += filled.start_of_exposure && !replaced_ ? half_readout_ns_ : -half_readout_ns_;
  if (last_ns_ && stamp_ns <= *last_ns_) {
    replaced_ = true;
    stamp_ns = std::max(now_ns - half_readout_ns_, *last_ns_ + 1);
  }
  last_ns_ = stamp_ns;
  return stamp_ns;
}

}  // namespace lumibox::hal::live
