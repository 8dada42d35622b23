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
  /// Look-ups are made eight at a time, a vector register full.
  static constexpr int kLanes = 8;
  using Floats = std::array<float, kLanes>;

  struct Places {
    alignas(32) Floats u{};          ///< tiles
    alignas(32) Floats v{};          ///< tiles
    alignas(32) Floats footprint{};  ///< width of the asking pixel in tiles
  };

  /// Linear light.
  struct Colors {
    alignas(32) Floats red;
    alignas(32) Floats green;
    alignas(32) Floats blue;
  };

  /// `base` is in linear light; width and height must be powers of two.
  explicit Texture(const LinearImage& base);

  /// A place is rounded to 1/256 of a texel, and far from the origin to what a float can tell
  /// apart.
  Colors sample(const Places& places) const;

 private:
  using Ints = std::array<std::int32_t, kLanes>;

  /// Ten bits each of the square roots of red, green and blue: as fine as a quarter of an 8-bit
  /// sRGB level, and cheap to undo.
  using Texel = std::uint32_t;
  static constexpr int kBits = 10;
  static constexpr std::uint32_t kMost = (1u << kBits) - 1;

  /// Steps that a texel is divided into: a whole number of them splits into texel and fraction
  /// without a branch.
  static constexpr int kStepBits = 8;

  /// A place among the texels of a level: the corners around it and its share of the way between.
  struct Corners {
    alignas(32) std::array<Ints, 4> texel;  ///< upper left, upper right, lower left, lower right
    alignas(32) Floats x;
    alignas(32) Floats y;
  };

  void add_level(const LinearImage& image);
  Corners corners(const Places& places, const Ints& level) const;
  Colors bilinear(const Places& places, const Ints& level) const;

  /// All levels one after the other, each in blocks of four by four texels, 64 bytes each:
  /// neighbours in the picture are neighbours in memory, whichever way the surface is turned.
  std::vector<Texel> texels_;
  std::array<std::int32_t, 32> first_{};  ///< texel of each level
  std::int32_t last_level_ = -1;
  float width_;   ///< of level 0
  float height_;  ///< of level 0
};

}  // namespace lumibox::hal::sim
