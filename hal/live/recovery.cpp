#include "hal/live/recovery.h"

#include <algorithm>

namespace lumibox::hal::live {
namespace {

// A device that only hiccuped is back in a quarter of a second; where udev does not tell, one that
// was plugged in is seen after four seconds at the latest.
constexpr std::int64_t kFirstDelayNs = 250'000'000;
constexpr std::int64_t kLongestDelayNs = 4'000'000'000;

}  // namespace

void Recovery::began(std::int64_t now_ns) {
  phase_ = Phase::Streaming;
  due_ns_ = now_ns + patience_ns_;
}

void Recovery::got_frame(std::int64_t now_ns) {
  began(now_ns);
  delay_ns_ = 0;
}

void Recovery::closed(std::int64_t now_ns) {
  phase_ = Phase::Closed;
  delay_ns_ = std::clamp(2 * delay_ns_, kFirstDelayNs, kLongestDelayNs);
  due_ns_ = now_ns + delay_ns_;
}

void Recovery::device_appeared(std::int64_t now_ns) {
  if (phase_ == Phase::Closed) due_ns_ = now_ns;
}

void Recovery::stopped() {
  phase_ = Phase::Idle;
  due_ns_ = kNever;
  delay_ns_ = 0;
}

Recovery::Action Recovery::due(std::int64_t now_ns) {
  if (now_ns < due_ns_) return Action::None;
  due_ns_ = now_ns + patience_ns_;
  switch (phase_) {
    case Phase::Idle:
      return Action::None;
    case Phase::Streaming:
      phase_ = Phase::Restarted;
      return Action::Restart;
    case Phase::Restarted:
      return Action::Close;
    case Phase::Closed:
      return Action::Open;
  }
  return Action::None;
}

}  // namespace lumibox::hal::live
