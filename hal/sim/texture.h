#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hal/sim/color.h"

namespace lumibox::hal::sim {

/// A colour picture that repeats in both directions, kept as a pyramid so that a look-up never sees
/// detail finer than the pixel that asks (Williams, "Pyramidal parametrics", 1983).
class Texture {
 public:
  /// `base` is in linear light; width and height must be powers of two.
  explicit Texture(const LinearImage& base);

  /// Linear light at (u, v), in tiles; `footprint` is the width of the asking pixel in tiles.
  Color sample(float u, float v, float footprint) const;

 private:
  struct Level {
    int width = 1;
    int height = 1;
    std::vector<std::array<std::uint8_t, 4>> texels;  ///< sRGB; the fourth byte only aligns
  };

  Color bilinear(const Level& level, float u, float v) const;

  const std::array<float, 256>& linear_;  ///< of an sRGB byte
  std::vector<Level> levels_;
  float base_texels_ = 1.0f;  ///< texels per tile at level 0, the denser direction
};

}  // namespace lumibox::hal::sim
