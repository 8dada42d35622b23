#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lumibox::hal::sim {

/// Red, green, blue. Linear light unless the name says srgb.
using Color = Eigen::Array3f;

/// sRGB transfer curve (IEC 61966-2-1), both ways, on [0, 1].
inline float linear_from_srgb(float s) {
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}
inline float srgb_from_linear(float l) {
  return l <= 0.0031308f ? l * 12.92f : 1.055f * std::pow(l, 1.0f / 2.4f) - 0.055f;
}
inline Color linear_from_srgb(const Color& srgb) {
  return {linear_from_srgb(srgb[0]), linear_from_srgb(srgb[1]), linear_from_srgb(srgb[2])};
}

/// The same from and to bytes, by table: the renderer's innermost loops.
const std::array<float, 256>& linear_from_srgb_byte_table();
class SrgbBytes {
 public:
  static const SrgbBytes& table();

  std::uint8_t operator()(float linear) const {
    // Written so that NaN becomes black.
    const float clamped = linear > 0.0f ? std::min(linear, 1.0f) : 0.0f;
    return bytes_[static_cast<std::size_t>(static_cast<int>(clamped * kSteps + 0.5f))];
  }

 private:
  SrgbBytes();

  /// Fine enough that the steepest part of the curve, at black, moves by 0.2 levels per entry.
  static constexpr int kSteps = 1 << 14;
  std::array<std::uint8_t, kSteps + 1> bytes_;
};

/// Relative luminance of linear light (Rec. 709).
inline float luminance(const Color& c) {
  return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
}

/// A picture in linear light, rows from the top.
struct LinearImage {
  int width = 0;
  int height = 0;
  std::vector<Color> pixels;

  LinearImage(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  Color* row(int y) {
    return pixels.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
  const Color* row(int y) const {
    return pixels.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
};

}  // namespace lumibox::hal::sim
