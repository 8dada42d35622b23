#include "app/modes/subject.h"

#include "app/saved_capture.h"

namespace lumibox::app {

SubjectMode::SubjectMode(Session& session, const geometry::Camera& camera)
    : session_(session), camera_(camera) {}

void SubjectMode::enter(const Moment&) {
  placed_ = false;
  depth_steps_ = 0;
  first_depth_.reset();
  aperture_.reset();
}

ModeId SubjectMode::press(const Gesture& gesture, const Moment& moment) {
  switch (gesture.button) {
    case hal::Button::Main:
      if (placed_) {
        return confirm(moment);
      }
      place();
      break;
    case hal::Button::Review:
      toggle_aperture();
      break;
    case hal::Button::Plus:
    case hal::Button::Minus:
      slide(steps_of(gesture));
      break;
    case hal::Button::Wipe:
      return take_back(moment);
  }
  return ModeId::Subject;
}

ModeId SubjectMode::update(const Moment& moment) {
  if (moment.tracked.state == tracking::TrackingState::Initialising) {
    return ModeId::Acquire;
  }
  if (moment.tracked.world_from_camera && !placed_) {
    aim(moment);
  }
  if (const auto subject = sphere(); subject && aperture_) {
    aperture_->update(moment, subject->center);
  }
  return ModeId::Subject;
}

std::string SubjectMode::title() const {
  if (aperture_) {
    return "focus on the subject";
  }
  return placed_ ? "the sphere is placed" : "aim at the subject";
}

Picture SubjectMode::draw(const Moment& moment) const {
  Picture picture;
  picture.title = title();
  picture.advice = tracking_advice(moment.tracked);
  picture.reticle = !placed_;
  const auto subject = sphere();
  if (!subject || !moment.tracked.world_from_camera) {
    return picture;
  }
  picture.world_from_view = moment.tracked.world_from_camera;
  if (aperture_) {
    picture.light_field = aperture_->draw(moment, subject->center, session_.config.render);
    picture.title += "  " + std::to_string(aperture_->frames()) + " pictures";
    if (picture.advice.empty()) {
      picture.advice = "wave the box a little; + and - focus, Main puts the sphere there";
    }
  } else {
    picture.coverage = render::Coverage{*subject, {}, std::nullopt, std::nullopt};
    if (picture.advice.empty()) {
      picture.advice = placed_
                           ? "+ and - slide the sphere; Main begins the capture"
                           : "Main puts the sphere here; + and - slide it; Review focuses instead";
    }
  }
  return picture;
}

void SubjectMode::aim(const Moment& moment) {
  const auto before = sphere();
  ray_ = ray_of_pixel(camera_, *moment.tracked.world_from_camera, reticle(camera_));
  if (!ray_) {
    return;
  }
  if (!aperture_) {
    const auto depth = depth_on_ray(*ray_, moment.map_points);
    first_depth_ = depth ? depth : first_depth_;
  } else if (before) {
    // The plane in focus stands still in the world while the box is waved before it.
    const double depth = ray_->direction.dot(before->center - ray_->origin);
    if (depth > 0.0) {
      first_depth_ = depth;
      depth_steps_ = 0;
    }
  }
}

std::optional<lightfield::Sphere> SubjectMode::sphere() const {
  if (!ray_ || !first_depth_) {
    return std::nullopt;
  }
  const auto& options = session_.config.capture;
  return sphere_on_ray(*ray_, slide_depth(*first_depth_, depth_steps_, options.depth_step),
                       options);
}

void SubjectMode::slide(int steps) {
  if (sphere()) {  // what is not seen is not slid
    depth_steps_ += steps;
  }
}

void SubjectMode::place() {
  placed_ = sphere().has_value();
  aperture_.reset();
}

void SubjectMode::toggle_aperture() {
  if (aperture_) {
    aperture_.reset();
    return;
  }
  placed_ = false;  // the focus follows the reticle again, at the depth it has
  aperture_ = std::make_unique<Aperture>(camera_, session_.config.aperture);
}

ModeId SubjectMode::take_back(const Moment& moment) {
  if (placed_ || aperture_) {
    enter(moment);
    return ModeId::Subject;
  }
  const bool capture_under_way = session_.recorder.light_field().subject().has_value();
  return capture_under_way ? ModeId::Capture : ModeId::Subject;
}

ModeId SubjectMode::confirm(const Moment& moment) {
  session_.recorder.begin(*sphere(), moment, next_capture_folder(session_.captures));
  return ModeId::Capture;
}

}  // namespace lumibox::app
