#pragma once

#include "hal/sim/color.h"
#include "hal/sim/scene_spec.h"

namespace lumibox::hal::sim {

/// Paints a texture: the pattern, then grain over it at every scale down to the texel. In linear
/// light.
LinearImage paint_texture(const TextureSpec& spec);

}  // namespace lumibox::hal::sim
