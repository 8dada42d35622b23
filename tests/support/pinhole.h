#pragma once

#include "geometry/camera.h"

namespace lumibox::testing {

/// A camera without distortion and with square pixels that looks through its picture's middle.
inline geometry::Camera pinhole(int width, int height, double focal_px) {
  config::CameraProfile profile;
  profile.width = width;
  profile.height = height;
  profile.fx = profile.fy = focal_px;
  profile.cx = (width - 1) / 2.0;
  profile.cy = (height - 1) / 2.0;
  return geometry::Camera(profile);
}

}  // namespace lumibox::testing
