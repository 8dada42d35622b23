#pragma once

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

}  // namespace lumibox::config
