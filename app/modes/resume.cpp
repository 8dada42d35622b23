#include "app/modes/resume.h"

#include <fmt/core.h>

namespace lumibox::app {

ModeId ResumeMode::press(const Gesture& gesture, const Moment&) {
  if (gesture.button == hal::Button::Review) {
    return ModeId::Review;
  }
  if (gesture.button == hal::Button::Main && gesture.press == Press::Long) {
    session_.waiting.reset();
    return ModeId::Acquire;
  }
  return ModeId::Resume;
}

ModeId ResumeMode::update(const Moment& moment) {
  if (session_.waiting->problem.empty() && moment.tracking_is_good()) {
    session_.waiting.reset();
    return ModeId::Capture;
  }
  return ModeId::Resume;
}

Picture ResumeMode::draw(const Moment& moment) const {
  const WaitingCapture& waiting = *session_.waiting;
  Picture picture;
  picture.title = fmt::format("{}  {} views", waiting.name,
                              session_.recorder.light_field().perspectives().size());
  if (!waiting.problem.empty()) {
    picture.alerts.push_back("cannot go on with it: " + waiting.problem);
    picture.advice = "Review shows it; hold Main for a new one";
  } else if (moment.tracked.reason == tracking::TrackingReason::TooDarkOrBlurred) {
    picture.advice = tracking_advice(moment.tracked);
  } else {
    picture.advice = "point at its subject to go on; hold Main for a new one";
  }
  return picture;
}

}  // namespace lumibox::app
