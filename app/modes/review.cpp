#include "app/modes/review.h"

#include <fmt/core.h>

#include <algorithm>
#include <numbers>

#include "app/orbit.h"
#include "app/placement.h"
#include "render/autofocus.h"

namespace lumibox::app {

void ReviewMode::enter(const Moment& moment) {
  focused_from_subject_.setZero();
  focus_steps_ = 0;
  stand_ = -1;
  steering_ = pose_of_box(moment) ? Steering::Box : Steering::Orbit;
  orbit_began_ns_ = moment.now_ns;
}

ModeId ReviewMode::press(const Gesture& gesture, const Moment& moment) {
  switch (gesture.button) {
    case hal::Button::Main:
      if (gesture.press == Press::Long) {
        steering_ = steering_ == Steering::Box ? Steering::Orbit : Steering::Box;
        orbit_began_ns_ = moment.now_ns;
      } else {
        aperture_ =
            aperture_ == render::Aperture::Small ? render::Aperture::Wide : render::Aperture::Small;
        focus_anew();
      }
      break;
    case hal::Button::Review:
      if (gesture.press == Press::Long) {
        stand_at_next_disagreeing();
        break;
      }
      return session_.waiting ? ModeId::Resume : ModeId::Capture;
    case hal::Button::Plus:
    case hal::Button::Minus:
      focus_steps_ += steps_of(gesture);
      break;
    case hal::Button::Wipe:
      wipe(gesture.press);
      break;
  }
  return ModeId::Review;
}

ModeId ReviewMode::update(const Moment& moment) {
  if (steering_ == Steering::Box) {
    // Without a pose the view stays where it was.
    const auto world_from_box = pose_of_box(moment);
    world_from_view_ = world_from_box ? world_from_box : world_from_view_;
  } else if (steering_ == Steering::Orbit) {
    const double period_s = session_.config.controls.orbit_period_s;
    const double time_s = 1e-9 * static_cast<double>(moment.now_ns - orbit_began_ns_);
    world_from_view_ =
        orbit_pose(session_.recorder.light_field(), 2.0 * std::numbers::pi * time_s / period_s);
  }
  return ModeId::Review;
}

Picture ReviewMode::draw(const Moment& moment) const {
  const auto& light_field = session_.recorder.light_field();
  const bool wide = aperture_ == render::Aperture::Wide;
  Picture picture;
  picture.title = fmt::format("review  {} views  {} aperture", light_field.perspectives().size(),
                              wide ? "wide" : "small");
  if (focus_steps_ != 0) {
    picture.title += fmt::format("  focus {:+}", focus_steps_);
  }
  picture.details = likeness(session_);
  picture.advice = advice(moment);
  if (!world_from_view_) {
    return picture;
  }
  picture.world_from_view = world_from_view_;
  picture.reticle = wide;  // what the focus goes to
  const config::Render& options = session_.config.render;
  picture.light_field =
      LightFieldPicture{equally_bright_perspectives(),
                        render::settings_from(options, aperture_, focus()), geometry()};
  return picture;
}

/// A wide aperture focuses on S, not on what serves the whole view.
render::Geometry ReviewMode::geometry() const {
  const auto geometry = render::geometry_named(session_.config.render.geometry);
  const bool moves_focus =
      aperture_ == render::Aperture::Wide && geometry == render::Geometry::Focal;
  return moves_focus ? render::Geometry::Plane : geometry;
}

std::vector<lightfield::Perspective> ReviewMode::equally_bright_perspectives() const {
  std::vector<lightfield::Perspective> perspectives =
      session_.recorder.light_field().perspectives();
  for (lightfield::Perspective& perspective : perspectives) {
    const auto gain = session_.quality.gains.find(perspective.id);
    if (gain != session_.quality.gains.end()) {
      perspective.gain = gain->second;
    }
  }
  return perspectives;
}

std::string ReviewMode::advice(const Moment& moment) const {
  const auto& disagreeing = session_.quality.disagreeing;
  if (session_.recorder.light_field().perspectives().empty()) {
    return "nothing recorded yet";
  }
  if (const std::string advice = tracking_advice(moment.tracked);
      steering_ == Steering::Box && !advice.empty()) {
    return advice;
  }
  if (steering_ == Steering::Stand && std::ranges::binary_search(disagreeing, stand_)) {
    return fmt::format("view {} does not fit: Wipe it, or hold Review", stand_);
  }
  if (disagreeing.empty()) {
    return {};
  }
  return disagreeing.size() == 1
             ? "1 view disagrees: hold Review to see it"
             : fmt::format("{} views disagree: hold Review to see them", disagreeing.size());
}

/// In order of id, and from the last to the first again; without any the view stays as it is.
void ReviewMode::stand_at_next_disagreeing() {
  const auto& disagreeing = session_.quality.disagreeing;
  if (disagreeing.empty()) {
    return;
  }
  const auto next = std::ranges::upper_bound(disagreeing, stand_);
  stand_ = next == disagreeing.end() ? disagreeing.front() : *next;
  const auto& perspectives = session_.recorder.light_field().perspectives();
  const auto perspective = std::ranges::find(perspectives, stand_, &lightfield::Perspective::id);
  if (perspective != perspectives.end()) {
    steering_ = Steering::Stand;
    world_from_view_ = perspective->world_from_camera;
  }
}

/// None also where the box is in another world than the light field.
std::optional<geometry::Pose> ReviewMode::pose_of_box(const Moment& moment) const {
  const bool same_world = !session_.waiting || session_.waiting->problem.empty();
  return same_world ? moment.tracked.world_from_camera : std::nullopt;
}

void ReviewMode::wipe(Press press) {
  if (press == Press::Long) {
    session_.recorder.undo_wipe();
  } else if (steering_ == Steering::Stand) {
    session_.recorder.wipe(stand_);  // once it is gone nothing: its neighbours are not to blame
  } else if (world_from_view_) {
    session_.recorder.wipe_nearest(world_from_view_->translation);
  }
}

/// The wide aperture's focus goes to what is under the reticle, or to S if nothing there tells;
/// that of the small one is at S.
void ReviewMode::focus_anew() {
  focused_from_subject_.setZero();
  focus_steps_ = 0;
  const auto& light_field = session_.recorder.light_field();
  if (aperture_ != render::Aperture::Wide || !world_from_view_) {
    return;
  }
  const Eigen::Vector3d subject = light_field.subject()->center;
  const auto ray = view_camera_.unproject(reticle(view_camera_));
  const auto depth = render::autofocus(
      {view_camera_, *world_from_view_}, light_field.perspectives(),
      render::settings_from(session_.config.render, render::Aperture::Wide, subject));
  if (ray && depth) {
    focused_from_subject_ = *world_from_view_ * (*depth * ray->homogeneous()) - subject;
  }
}

Eigen::Vector3d ReviewMode::focus() const {
  // What was focused on, slid along the view's axis: the planes of thesis 3.1 come nearer or go
  // farther with it.
  const Eigen::Vector3d focused =
      session_.recorder.light_field().subject()->center + focused_from_subject_;
  const Eigen::Vector3d forward = world_from_view_->rotation * Eigen::Vector3d::UnitZ();
  const double depth = forward.dot(focused - world_from_view_->translation);
  if (depth <= 0.0) {
    return focused;  // behind the view
  }
  const double slid = slide_depth(depth, focus_steps_, session_.config.capture.depth_step);
  return focused + (slid - depth) * forward;
}

}  // namespace lumibox::app
