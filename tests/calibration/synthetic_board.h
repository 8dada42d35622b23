#pragma once

#include <cstdint>
#include <vector>

#include "calibration/board.h"
#include "config/camera_profile.h"
#include "geometry/pose.h"
#include "hal/image.h"

namespace lumibox::test {

/// A webcam of 62 degrees with a lens that distorts, and a fisheye lens of 150 degrees across.
config::CameraProfile webcam();
config::CameraProfile fisheye_camera();

/// `count` poses of the board that spread over the picture, at changing distances, with tilts up to
/// `tilt_deg` about changing axes.
std::vector<geometry::Pose> varied_poses(const calibration::Board& board,
                                         const config::CameraProfile& camera, int count,
                                         double tilt_deg = 40.0);

/// The corners inside the picture, each coordinate with Gaussian noise.
calibration::Sighting observe(const calibration::Board& board, const config::CameraProfile& camera,
                              const geometry::Pose& camera_from_board, double noise_px,
                              std::uint32_t seed);

/// One sighting for each pose, each with its own noise.
std::vector<calibration::Sighting> observe_all(const calibration::Board& board,
                                               const config::CameraProfile& camera,
                                               const std::vector<geometry::Pose>& poses,
                                               double noise_px, std::uint32_t seed);

/// A grey picture of the board before a grey wall.
hal::Image picture_of(const calibration::Board& board, const config::CameraProfile& camera,
                      const geometry::Pose& camera_from_board);

}  // namespace lumibox::test
