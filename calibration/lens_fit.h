#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calibration/board.h"
#include "config/camera_profile.h"
#include "geometry/pose.h"

namespace lumibox::calibration {

/// A lens, and where the board was in each sighting.
struct LensFit {
  config::CameraProfile profile;
  std::vector<geometry::Pose> camera_from_board;  ///< metres
};

/// Lens and poses that explain the sightings best: Zhang, "A flexible new technique for camera
/// calibration" (2000), or Kannala and Brandt (2006), by OpenCV. None if it finds no solution or
/// one that is no camera's.
std::optional<LensFit> fit_lens(const Board& board, std::span<const Sighting> sightings, int width,
                                int height, config::LensModel model);

/// Root mean square of the distances between corners seen and predicted, pixels; infinite if the
/// lens cannot see one of them.
double error_px(const Board& board, const Sighting& sighting, const config::CameraProfile& profile,
                const geometry::Pose& camera_from_board);

}  // namespace lumibox::calibration
