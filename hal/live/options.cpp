#include "hal/live/options.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "config/error.h"

namespace lumibox::hal::live {
namespace {

// Of a camera that nobody calibrated: what webcams have, more or less, as for a bare video.
constexpr double kAssumedFieldOfViewDeg = 60.0;

config::CameraProfile assumed_profile(const Mode& mode) {
  config::CameraProfile profile;
  profile.width = mode.width;
  profile.height = mode.height;
  profile.fx = mode.width / 2.0 / std::tan(kAssumedFieldOfViewDeg / 2.0 * std::numbers::pi / 180.0);
  profile.fy = profile.fx;
  profile.cx = (mode.width - 1) / 2.0;
  profile.cy = (mode.height - 1) / 2.0;
  return profile;
}

double rate_of(const CameraOptions& options, const Mode& mode) {
  const double rate = mode.interval.rate_hz();
  return rate > 0.0 ? rate : options.wishes.rate_hz;
}

}  // namespace

Wish wish_of(const CameraOptions& options) {
  const config::Camera& wishes = options.wishes;
  Wish wish;
  wish.format = format_named(wishes.format);
  wish.rate_hz = wishes.rate_hz;
  if (!options.calibration) {
    wish.width = wishes.width != 0 ? wishes.width : wish.width;
    wish.height = wishes.height != 0 ? wishes.height : wish.height;
    return wish;
  }
  const config::CameraProfile& profile = *options.calibration;
  if ((wishes.width != 0 && wishes.width != profile.width) ||
      (wishes.height != 0 && wishes.height != profile.height)) {
    throw config::InputError(fmt::format(
        "camera.width and camera.height are {} and {}; the camera is calibrated at {}x{}: "
        "expected that, or 0",
        wishes.width, wishes.height, profile.width, profile.height));
  }
  wish.exact_size = true;
  wish.width = profile.width;
  wish.height = profile.height;
  return wish;
}

config::CameraProfile profile_of(const CameraOptions& options, const Mode& mode) {
  config::CameraProfile profile =
      options.calibration ? *options.calibration : assumed_profile(mode);
  profile.fps = rate_of(options, mode);
  return profile;
}

Introduction introduction_of(const CameraOptions& options, const std::string& name,
                             const std::string& offer, const Mode& mode) {
  Introduction words;
  words.info = fmt::format("camera {} has {}; chosen: {}", name, offer, to_string(mode));
  if (!options.calibration) {
    words.warnings.push_back(
        fmt::format("camera {}: no calibration; a horizontal field of view of {:.0f} degrees is "
                    "assumed",
                    name, kAssumedFieldOfViewDeg));
  }
  return words;
}

StreamSettings settings_of(const CameraOptions& options, const Mode& mode) {
  StreamSettings settings;
  if (options.calibration) {
    settings.readout_ns = std::llround(1e9 * options.calibration->readout_s);
  }
  settings.patience_ns = std::llround(1e9 * options.wishes.stall_periods / rate_of(options, mode));
  return settings;
}

bool contains_in_any_case(std::string_view text, std::string_view part) {
  const auto same = [](unsigned char a, unsigned char b) {
    return std::tolower(a) == std::tolower(b);
  };
  return !std::ranges::search(text, part, same).empty();
}

}  // namespace lumibox::hal::live
