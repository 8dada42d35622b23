#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/camera_profile.h"
#include "config/config.h"
#include "hal/live/modes.h"
#include "hal/live/streamer.h"

namespace lumibox::hal {

/// What is asked of a real camera.
struct CameraOptions {
  /// Which: its backend says what it takes; "auto": the first that will do.
  std::string device = "auto";
  /// Of the camera, in the size that it is to be used at; none: a field of view is assumed, and
  /// said.
  std::optional<config::CameraProfile> calibration;
  config::Camera wishes;
};

namespace live {

/// The calibration decides the size. Throws config::InputError if the wishes say another.
Wish wish_of(const CameraOptions& options);

/// What is known of a camera that was set to a mode, with the rate that it runs at.
config::CameraProfile profile_of(const CameraOptions& options, const Mode& mode);

/// What there is to be said of a camera before its first picture: by level.
struct Introduction {
  std::string info;
  std::vector<std::string> warnings;
};

/// What was chosen of what there was, and what is assumed without a calibration.
Introduction introduction_of(const CameraOptions& options, const std::string& name,
                             const std::string& offer, const Mode& mode);

StreamSettings settings_of(const CameraOptions& options, const Mode& mode);

/// Whether a camera that calls itself `text` goes by the name of `part`.
bool contains_in_any_case(std::string_view text, std::string_view part);

}  // namespace live
}  // namespace lumibox::hal
