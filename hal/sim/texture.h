#pragma once

#include <cstdint>
#include <vector>

#include "hal/sim/color.h"
#include "hal/sim/float4.h"

namespace lumibox::hal::sim {

/// A colour picture that repeats in both directions, kept as a pyramid so that a look-up never sees
/// detail finer than the pixel that asks (Williams, "Pyramidal parametrics", 1983).
class Texture {
 public:
  /// `base` is in linear light; width and height must be powers of two.
  explicit Texture(const LinearImage& base);

  /// Linear light at (u, v), in tiles; `footprint` is the width of the asking pixel in tiles. The
  /// place is rounded to 1/256 of a texel, and far from the origin to what a float can tell apart.
  Float4 sample(float u, float v, float footprint) const;

 private:
  /// Linear light, 65535 at 1: a twentieth of an 8-bit level even at black, where the sRGB curve
  /// is steepest. The fourth value only makes a texel as wide as a vector register wants it.
  using Texel = std::uint16_t __attribute__((vector_size(8)));

  /// Texels in blocks of four by four, 128 bytes each: neighbours in the picture are
  /// neighbours in memory, whichever way the surface is turned.
  struct Level {
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    std::uint32_t blocks_per_row = 1;
    std::vector<Texel> texels;

    /// The texel (x, y) lies at row_place(y) + column_place(x); both are within the level.
    std::uint32_t row_place(std::uint32_t y) const {
      return ((y >> 2) * blocks_per_row) << 4 | (y & 3) << 2;
    }
    static std::uint32_t column_place(std::uint32_t x) { return (x >> 2) << 4 | (x & 3); }
  };

  static Level level_of(const LinearImage& image);
  static Float4 floats(const Texel& texel);
  static Float4 bilinear(const Level& level, float u, float v);

  std::vector<Level> levels_;
  float base_texels_ = 1.0f;  ///< texels per tile at level 0, the denser direction
};

}  // namespace lumibox::hal::sim
