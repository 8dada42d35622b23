#include "app/modes/capture.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumibox::app {
namespace {

/// Pixels; beyond, the camera is about to enter the sphere and the number tells nothing.
constexpr double kMostGhosting = 1000.0;

}  // namespace

CaptureMode::CaptureMode(Session& session, const geometry::Camera& camera)
    : session_(session),
      focal_px_(camera.profile().fx),
      guide_(session.config.capture.widest_gap_deg * std::numbers::pi / 180.0) {}

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
  holes_ = guide_.holes(session_.recorder.light_field(), session_.threshold);
  return ModeId::Capture;
}

bool CaptureMode::wants_to_record(const Moment& moment) const {
  return !paused_ && session_.recorder.accepts(moment, session_.threshold);
}

Picture CaptureMode::draw(const Moment& moment) const {
  Picture picture;
  picture.title = title(moment);
  picture.details = details();
  picture.advice = tracking_advice(moment.tracked);
  if (const auto& world_from_camera = moment.tracked.world_from_camera) {
    picture.world_from_view = world_from_camera;
    picture.coverage = coverage(*world_from_camera);
    if (holes_.largest) {
      picture.way = way_to(*holes_.largest, *world_from_camera, picture.coverage->sphere.center,
                           session_.threshold);
    }
  }
  return picture;
}

std::string CaptureMode::title(const Moment& moment) const {
  std::string title = std::string(paused_ ? "paused" : "capture") + "  " + views_and_gate(session_);
  if (const auto& world_from_camera = moment.tracked.world_from_camera) {
    const lightfield::Sphere& sphere = *session_.recorder.light_field().subject();
    const double distance = (world_from_camera->translation - sphere.center).norm();
    const double ghosting =
        lightfield::expected_ghosting(focal_px_, session_.threshold, sphere.radius / distance);
    if (ghosting < kMostGhosting) {
      title += fmt::format("  ghosting {:.0f} px", ghosting);
    }
  }
  return title;
}

std::string CaptureMode::details() const {
  std::string details = likeness(session_);
  if (holes_.missing > 0) {
    details += fmt::format("{}{} missing", details.empty() ? "" : "   ", holes_.missing);
  }
  return details;
}

render::Coverage CaptureMode::coverage(const geometry::Pose& world_from_camera) const {
  const auto& light_field = session_.recorder.light_field();
  const render::CaptureQuality& quality = session_.quality;
  render::Coverage coverage{
      *light_field.subject(), {}, world_from_camera.translation, holes_.largest};
  for (const auto& perspective : light_field.perspectives()) {
    const auto psnr = quality.psnr.find(perspective.id);
    coverage.recorded.push_back(
        {perspective.center(),
         psnr == quality.psnr.end() ? std::nullopt : std::optional(psnr->second),
         std::ranges::binary_search(quality.disagreeing, perspective.id)});
  }
  return coverage;
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
