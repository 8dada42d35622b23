#pragma once

#include <cstdint>
#include <optional>

#include "hal/live/filled.h"

/// Which picture of the camera a buffer is, and of when.
namespace lumibox::hal::live {

/// Numbers the pictures of a camera from 0, over all its streams, with gaps where the driver's
/// sequence has them.
class Numbering {
 public:
  /// A stream begins, and the driver's sequence anew.
  void begin_stream() { last_sequence_.reset(); }

  /// The number of the next buffer's picture.
  std::int64_t next(std::uint32_t sequence);

  /// How many numbers the last picture was ahead of the one before it, less one.
  std::int64_t missed() const { return missed_; }

 private:
  std::int64_t last_ = -1;
  std::int64_t missed_ = 0;
  std::optional<std::uint32_t> last_sequence_;
};

/// Times of the middle of the picture's exposure, strictly increasing. What the driver says is
/// corrected for half the readout; how long it exposed and took to transfer is not known, so all
/// may be some milliseconds off, each alike.
class Stamping {
 public:
  explicit Stamping(std::int64_t readout_ns) : half_readout_ns_(readout_ns / 2) {}

  /// A stamp of another clock, from the future or no later than the one before is replaced by
  /// `now`, the time at which the buffer came.
  std::int64_t stamp(const Filled& filled, std::int64_t now_ns);

  /// Whether the last stamp was replaced.
  bool replaced() const { return replaced_; }

 private:
  std::int64_t half_readout_ns_;
  std::optional<std::int64_t> last_ns_;
  bool replaced_ = false;
};

}  // namespace lumibox::hal::live
