#pragma once

#include <vector>

#include "hal/image.h"
#include "lightfield/perspective.h"
#include "render/view.h"

namespace lumibox::render {

/// The light field seen from a view, computed on the CPU in double precision, one pixel after the
/// other, by intersecting each pixel's ray with each proxy plane: the plainest form of thesis 3,
/// for checking the GL renderer and for `--reference`. Three channels, size of view.camera. Pixels
/// that no perspective covers are black.
hal::Image render_reference(const View& view,
                            const std::vector<lightfield::Perspective>& perspectives,
                            const Settings& settings);

}  // namespace lumibox::render
