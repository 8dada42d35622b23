#include "app/modes/modes.h"

#include "app/modes/acquire.h"
#include "app/modes/capture.h"
#include "app/modes/resume.h"
#include "app/modes/review.h"
#include "app/modes/subject.h"

namespace lumibox::app {

Modes::Modes(Session& session, const geometry::Camera& camera)
    : session_(session),
      modes_{std::make_unique<AcquireMode>(), std::make_unique<SubjectMode>(session, camera),
             std::make_unique<CaptureMode>(session, camera),
             std::make_unique<ReviewMode>(session, camera), std::make_unique<ResumeMode>(session)},
      current_(session.waiting ? ModeId::Resume : ModeId::Acquire) {}

Decision Modes::decide(const std::vector<Gesture>& gestures, const Moment& moment) {
  start_over_ = false;
  for (const Gesture& gesture : gestures) {
    if (asks_for_figures(gesture)) {
      session_.figures = !session_.figures;
    } else {
      go_to(mode(current_).press(gesture, moment), moment);
    }
  }
  go_to(mode(current_).update(moment), moment);
  const bool capturing = current_ == ModeId::Capture || current_ == ModeId::Review;
  return {mode(current_).wants_to_record(moment), capturing, mode(current_).is_recording(),
          start_over_};
}

/// In Review holding the button has another meaning.
bool Modes::asks_for_figures(const Gesture& gesture) const {
  return gesture.button == hal::Button::Review && gesture.press == Press::Long &&
         current_ != ModeId::Review;
}

void Modes::go_to(ModeId next, const Moment& moment) {
  while (next != current_) {
    start_over_ = start_over_ || (current_ == ModeId::Resume && next == ModeId::Acquire);
    current_ = next;
    mode(current_).enter(moment);
    next = mode(current_).update(moment);  // so that it has something to show in this very tick
  }
}

}  // namespace lumibox::app
