#pragma once

#include <optional>
#include <string>

namespace lumibox::config {

/// What is known of a camera before it is opened: OPENCV distortion model, pixel centres at
/// integers, lengths in pixels. Comes from calib.txt, a profile file, or a recording.
struct CameraProfile {
  int width = 640;         ///< pixels
  int height = 480;        ///< pixels
  double fx = 540.0;       ///< focal length, pixels
  double fy = 540.0;       ///< focal length, pixels
  double cx = 319.5;       ///< principal point, pixels
  double cy = 239.5;       ///< principal point, pixels
  double k1 = 0.0;         ///< radial distortion, r^2
  double k2 = 0.0;         ///< radial distortion, r^4
  double p1 = 0.0;         ///< tangential distortion
  double p2 = 0.0;         ///< tangential distortion
  double k3 = 0.0;         ///< radial distortion, r^6
  double fps = 30.0;       ///< frames per second
  double readout_s = 0.0;  ///< time from first to last row; 0 = global shutter
};

/// What is implausible about a profile, in words that name the number and its range; none if it can
/// be the description of a real camera.
std::optional<std::string> fault_of(const CameraProfile& profile);

}  // namespace lumibox::config
