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

  /// Linear light at (u, v), in tiles; `footprint` is the width of the asking pixel in tiles.
  Float4 sample(float u, float v, float footprint) const;

 private:
  /// Linear light, 65535 at 1: a twentieth of an 8-bit level even at black, where the sRGB curve
  /// is steepest. The fourth value only makes a texel as wide as a vector register wants it.
  using Texel = std::uint16_t __attribute__((vector_size(8)));

  /// Texels in Morton order: neighbours in the picture are neighbours in memory, whichever way the
  /// surface is turned. The texel (x, y) is at column_place[x] + row_place[y].
  struct Level {
    int width = 1;
    int height = 1;
    std::vector<std::uint32_t> column_place;
    std::vector<std::uint32_t> row_place;
    std::vector<Texel> texels;
  };

  static Level level_of(const LinearImage& image);
  static Float4 floats(const Texel& texel);
  static Float4 bilinear(const Level& level, float u, float v);

  std::vector<Level> levels_;
  float base_texels_ = 1.0f;  ///< texels per tile at level 0, the denser direction
};

}  // namespace lumibox::hal::sim
