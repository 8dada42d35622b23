#pragma once

#include <optional>
#include <string>

namespace lumibox::config {

/// How a lens bends light, with OpenCV's equations and coefficients.
enum class LensModel {
  Opencv,   ///< pinhole with radial and tangential distortion: k1 k2 p1 p2 k3 (Brown, 1966)
  Fisheye,  ///< theta (1 + k1 theta^2 + ... + k4 theta^8) (Kannala and Brandt, 2006): k1 k2 k3 k4
};

/// As profiles and captures have it: "opencv" or "fisheye".
const char* name_of(LensModel model);

/// What is known of a camera before it is opened: pixel centres at integers, lengths in pixels.
/// Comes from calib.txt, a profile file, or a recording.
struct CameraProfile {
  int width = 640;    ///< pixels
  int height = 480;   ///< pixels
  double fx = 540.0;  ///< focal length, pixels
  double fy = 540.0;  ///< focal length, pixels
  double cx = 319.5;  ///< principal point, pixels
  double cy = 239.5;  ///< principal point, pixels
  LensModel model = LensModel::Opencv;
  double k1 = 0.0;         ///< radial distortion, r^2 (fisheye: theta^2, and so on)
  double k2 = 0.0;         ///< radial distortion, r^4
  double p1 = 0.0;         ///< tangential distortion; 0 of a fisheye lens
  double p2 = 0.0;         ///< tangential distortion; 0 of a fisheye lens
  double k3 = 0.0;         ///< radial distortion, r^6
  double k4 = 0.0;         ///< radial distortion, theta^8; 0 unless of a fisheye lens
  double fps = 30.0;       ///< frames per second
  double readout_s = 0.0;  ///< time from first to last row; 0 = global shutter
};

/// What is implausible about a profile, in words that name the number and its range; none if it can
/// be the description of a real camera.
std::optional<std::string> fault_of(const CameraProfile& profile);

}  // namespace lumibox::config
