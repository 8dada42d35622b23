#include "app/modes/mode.h"

#include <fmt/core.h>

#include <numbers>

namespace lumibox::app {

int steps_of(const Gesture& gesture) {
  constexpr int kLongSteps = 5;
  const int steps = gesture.press == Press::Long ? kLongSteps : 1;
  switch (gesture.button) {
    case hal::Button::Plus:
      return steps;
    case hal::Button::Minus:
      return -steps;
    default:
      return 0;
  }
}

std::string views_and_gate(const Session& session) {
  return fmt::format("{} views  gate {:.1f}\u00b0",
                     session.recorder.light_field().perspectives().size(),
                     session.threshold * 180.0 / std::numbers::pi);
}

std::string likeness(const Session& session) {
  const render::CaptureQuality& quality = session.quality;
  return quality.psnr.empty()
             ? std::string{}
             : fmt::format("likeness {:.1f} dB of {}", quality.median_psnr, quality.psnr.size());
}

std::string tracking_advice(const tracking::TrackedFrame& tracked) {
  if (tracked.state == tracking::TrackingState::Good) {
    return {};
  }
  return tracking::advice(tracked.reason);
}

}  // namespace lumibox::app
