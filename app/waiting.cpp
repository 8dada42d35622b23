#include "app/waiting.h"

#include "config/log.h"

namespace lumibox::app {
namespace {

/// Between two looks for what is missing: long for a device, short for a person with a plug in the
/// hand.
constexpr std::int64_t kLookEvery_ns = 1'000'000'000;

/// Screen wants a camera; nothing that one sees is shown.
geometry::Camera camera_of_size(int width, int height) {
  config::CameraProfile profile;
  profile.width = width;
  profile.height = height;
  profile.fx = profile.fy = width;
  profile.cx = 0.5 * (width - 1);
  profile.cy = 0.5 * (height - 1);
  return geometry::Camera(profile);
}

}  // namespace

Waiting::Waiting(Devices& devices, const config::Config& config)
    : devices_(devices),
      options_(config.render),
      look_again_ns_(devices.clock->now_ns() + kLookEvery_ns) {
  picture_.advice = "waiting for the camera: is it plugged in?";
  if (!over()) say();
}

void Waiting::tick() {
  devices_.buttons->poll();  // what is pressed now is not meant for later
  if (devices_.clock->now_ns() >= look_again_ns_) look_again();
  if (!over()) show();
}

void Waiting::look_again() {
  const std::string before = devices_.missing;
  open_missing(devices_);
  look_again_ns_ = devices_.clock->now_ns() + kLookEvery_ns;
  if (devices_.missing != before) say();
}

void Waiting::say() {
  if (over()) {
    config::log_info("the box has its camera and its screen");
  } else {
    config::log_warning("waiting: " + devices_.missing);
  }
  picture_.title = devices_.display ? "no camera" : "no screen";
}

void Waiting::show() {
  picture_.alerts = standing_alerts_;
  picture_.alerts.push_back(devices_.missing);
  if (const auto error = devices_.buttons->error()) {
    picture_.alerts.push_back("buttons: " + *error);
  }
  if (!devices_.display) {
    ++unseen_;
    return;
  }
  hal::Display& display = *devices_.display;
  if (!screen_) {
    screen_.emplace(display, *devices_.clock, camera_of_size(display.width(), display.height()),
                    options_, render::Estimating::AtOnce);
  }
  screen_->draw(picture_, hal::Frame{}, look_again_ns_);
  screen_->present();
}

std::int64_t Waiting::presented() const {
  return unseen_ + (devices_.display ? devices_.display->presented() : 0);
}

}  // namespace lumibox::app
