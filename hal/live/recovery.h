#pragma once

#include <cstdint>
#include <limits>

namespace lumibox::hal::live {

/// What to do about a stream that gives nothing: first it is begun anew, then its device is closed,
/// then opened again, at growing intervals until a frame comes. Knows only what happened and when;
/// times are of the clock, in nanoseconds.
class Recovery {
 public:
  enum class Action {
    None,
    Restart,  ///< stop the stream and begin it anew
    Close,    ///< the device: restarting did not help
    Open,     ///< look for the device
  };

  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  /// A stream without a frame for `patience_ns` is stalled.
  explicit Recovery(std::int64_t patience_ns) : patience_ns_(patience_ns) {}

  void began(std::int64_t now_ns);      ///< a stream; its first frame may take as long as any
  void got_frame(std::int64_t now_ns);  ///< all is well
  void closed(std::int64_t now_ns);  ///< the device is gone, or another attempt to open it failed
  void device_appeared(std::int64_t now_ns);  ///< some device: worth an attempt
  void stopped();                             ///< nothing is expected any more

  /// What is due now; each is said once.
  Action due(std::int64_t now_ns);

  /// When due() will have something to say if nothing happens until then.
  std::int64_t due_ns() const { return due_ns_; }

 private:
  enum class Phase { Idle, Streaming, Restarted, Closed };

  std::int64_t patience_ns_;
  Phase phase_ = Phase::Idle;
  std::int64_t due_ns_ = kNever;
  std::int64_t delay_ns_ = 0;  ///< before the next attempt to open; 0: none yet since a frame
};

}  // namespace lumibox::hal::live
