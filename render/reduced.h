#pragma once

#include <optional>

#include "lightfield/perspective.h"

namespace lumibox::render {

/// The same perspective with a smaller picture, halved until it has at most `max_pixels`, and the
/// camera that takes such pictures; one that is small enough keeps its own. The pixels stay in
/// memory. None if the picture is lost. Precondition: it has a photo and a camera.
std::optional<lightfield::Perspective> reduced(const lightfield::Perspective& perspective,
                                               int max_pixels);

}  // namespace lumibox::render
