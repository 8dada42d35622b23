#pragma once

#include <array>
#include <numbers>
#include <span>
#include <string>

#include "calibration/board.h"
#include "geometry/pose.h"

namespace lumibox::calibration {

/// Whether sightings can determine a lens, and what is missing; pure, so that a person can be told
/// while the pictures are taken. Thresholds: docs/calibration.md.

/// How many corners lie in each ninth of the picture, rows from the top.
using Coverage = std::array<std::array<int, 3>, 3>;
Coverage coverage_of(std::span<const Sighting> sightings, int width, int height);

/// Names of the ninths with fewer corners than a distortion needs there: "upper left, middle", or
/// nothing.
std::string uncovered_parts(const Coverage& coverage);

/// Angle between the board's normal and the optical axis, radians; 0 if the board is frontal.
double tilt_of(const geometry::Pose& camera_from_board);

double largest_tilt(std::span<const geometry::Pose> camera_from_board);

/// Largest angle between the board's normals in two views, radians: 0 if all planes are parallel,
/// from which no lens can be found however the board is moved or turned in its plane (Zhang 2000,
/// section 4).
double tilt_spread(std::span<const geometry::Pose> camera_from_board);

/// One corner could be a wrong one. (OpenCV's samples, a good set, have four in the sparsest.)
inline constexpr int kFewestCornersInANinth = 3;

/// Radians. Zhang (2000), figure 3: the error of a focal length falls until the planes make some 45
/// degrees with the picture, and is several times as large at 10.
inline constexpr double kLeastTilt = 15.0 * std::numbers::pi / 180.0;
inline constexpr double kLeastTiltSpread = 20.0 * std::numbers::pi / 180.0;

}  // namespace lumibox::calibration
