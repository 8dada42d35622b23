#pragma once

#include "config/camera_profile.h"

namespace lumibox::geometry {

/// Intrinsics of a webcam, fx not fy and the principal point off the middle; no distortion yet.
inline config::CameraProfile webcam() {
  config::CameraProfile profile;
  profile.width = 640;
  profile.height = 480;
  profile.fx = 520.0;
  profile.fy = 525.0;
  profile.cx = 325.0;
  profile.cy = 235.0;
  return profile;
}

}  // namespace lumibox::geometry
