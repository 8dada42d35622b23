#pragma once

#include <initializer_list>
#include <string>

#include "hal/sim/random.h"
#include "hal/sim/scene_spec.h"

namespace lumibox::hal::sim {

/// Colours (sRGB) that go together: hues near each other, dark and light in turn; with much
/// contrast perhaps accents. `contrast` in [0, 1] says how far dark and light are apart.
std::vector<Color> random_palette(int colors, double contrast, Random& random);

/// A texture with one of the patterns for a surface of `width` times `height` metres, with texels
/// as fine as `texel_m` where memory allows. Cells, palette, contrast and grain are drawn.
TextureSpec random_texture(const std::string& name, std::initializer_list<Pattern> patterns,
                           double width, double height, double texel_m, Random& random);

}  // namespace lumibox::hal::sim
