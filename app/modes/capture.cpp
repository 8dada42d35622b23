#include "app/modes/capture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace lumibox::app {

void CaptureMode::enter(const Moment&) {
  paused_ = false;
  session_.recorder.set_threshold(session_.threshold);
}

ModeId CaptureMode::press(const Gesture& gesture, const Moment& moment) {
  switch (gesture.button) {
    case hal::Button::Main:
      if (gesture.press == Press::Long) {
        return ModeId::Subject;
      }
      paused_ = !paused_;
      break;
    case hal::Button::Review:
      return ModeId::Review;
    case hal::Button::Plus:
    case hal::Button::Minus:
      change_threshold(steps_of(gesture));
      break;
    case hal::Button::Wipe:
      wipe(gesture.press, moment);
      break;
  }
  return ModeId::Capture;
}

ModeId CaptureMode::update(const Moment&) {
  return ModeId::Capture;
}

bool CaptureMode::wants_to_record(const Moment& moment) const {
  return !paused_ && session_.recorder.accepts(moment, session_.threshold);
}

Picture CaptureMode::draw(const Moment& moment) const {
  const auto& light_field = session_.recorder.light_field();
  Picture picture;
  picture.title = std::string(paused_ ? "paused" : "capture") + "  " + views_and_gate(session_);
  picture.advice = tracking_advice(moment.tracked);
  if (!moment.tracked.world_from_camera) {
    return picture;
  }
  CoveragePicture coverage;
  coverage.sphere = *light_field.subject();
  coverage.current = moment.tracked.world_from_camera->translation;
  for (const auto& perspective : light_field.perspectives()) {
    coverage.recorded.push_back(perspective.center());
  }
  picture.world_from_view = moment.tracked.world_from_camera;
  picture.coverage = std::move(coverage);
  return picture;
}

void CaptureMode::change_threshold(int steps) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  const auto& options = session_.config.capture;
  session_.threshold =
      std::clamp(session_.threshold * std::pow(options.threshold_step, steps),
                 options.threshold_min_deg * kRadians, options.threshold_max_deg * kRadians);
  session_.recorder.set_threshold(session_.threshold);
}

void CaptureMode::wipe(Press press, const Moment& moment) {
  if (press == Press::Long) {
    session_.recorder.undo_wipe();
  } else if (moment.tracked.world_from_camera) {
    session_.recorder.wipe_nearest(moment.tracked.world_from_camera->translation);
    paused_ = true;  // or the gate would take the same view again at once
  }
}

}  // namespace lumibox::app
