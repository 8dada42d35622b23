#pragma once

#include <Eigen/Core>
#include <vector>

#include "hal/image.h"
#include "lightfield/perspective.h"
#include "render/view.h"

namespace lumibox::render {

/// What is seen at a pixel: less light where it is not all covered by the recorded pictures.
struct CoveredLight {
  Eigen::Vector3d light = Eigen::Vector3d::Zero();
  double covered = 0.0;  ///< 0 to 1
};

/// The light field seen from a view, computed on the CPU in double precision, one pixel after the
/// other, by intersecting each pixel's ray with each proxy plane: the plainest form of thesis 3,
/// for checking the GL renderer and for `--reference`. Three channels, size of view.camera. Pixels
/// that no perspective covers are black.
hal::Image render_reference(const View& view,
                            const std::vector<lightfield::Perspective>& perspectives,
                            const Settings& settings);

/// The same before it is rounded, row by row.
std::vector<CoveredLight> reference_light(const View& view,
                                          const std::vector<lightfield::Perspective>& perspectives,
                                          const Settings& settings);

/// Light as a picture has it; more than white is white.
hal::Image stored_picture(const std::vector<CoveredLight>& light, int width, int height);

}  // namespace lumibox::render
