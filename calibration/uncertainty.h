#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "calibration/lens_fit.h"

namespace lumibox::calibration {

/// One number of a lens.
struct Parameter {
  std::string_view name;
  double config::CameraProfile::*member;
};

/// The numbers that a calibration finds.
std::span<const Parameter> parameters_of(config::LensModel model);

/// Standard deviation of each of parameters_of(): the fit's covariance with the poses free, and the
/// corners' noise as large as what the fit leaves over (Hartley and Zisserman, Multiple View
/// Geometry, 2nd edition, section 5.2). Infinite where the sightings do not determine it.
std::vector<double> standard_deviations(const Board& board, std::span<const Sighting> sightings,
                                        const LensFit& fit);

}  // namespace lumibox::calibration
