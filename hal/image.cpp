#include "hal/image.h"

namespace lumibox::hal {
namespace {

/// Rec. 601 luma, 0.299 R + 0.587 G + 0.114 B, in 16-bit fixed point; the weights sum to 2^16, so
/// that white stays 255 and a grey pixel keeps its value.
std::uint8_t luma(const std::uint8_t* rgb) {
  constexpr std::uint32_t kRed = 19595;
  constexpr std::uint32_t kGreen = 38470;
  constexpr std::uint32_t kBlue = 7471;
  static_assert(kRed + kGreen + kBlue == 1U << 16);
  return static_cast<std::uint8_t>(
      (kRed * rgb[0] + kGreen * rgb[1] + kBlue * rgb[2] + (1U << 15)) >> 16);
}

}  // namespace

Image to_gray(const Image& image) {
  if (image.channels() != 3) {
    return image;
  }
  Image gray(image.width(), image.height(), 1);
  const std::uint8_t* source = image.data();
  std::uint8_t* target = gray.data();
  for (std::size_t i = 0; i < gray.size_bytes(); ++i) {
    target[i] = luma(source + 3 * i);
  }
  return gray;
}

Image to_rgb(const Image& image) {
  if (image.channels() != 1) {
    return image;
  }
  Image color(image.width(), image.height(), 3);
  const std::uint8_t* source = image.data();
  std::uint8_t* target = color.data();
  for (std::size_t i = 0; i < image.size_bytes(); ++i) {
    target[3 * i] = target[3 * i + 1] = target[3 * i + 2] = source[i];
  }
  return color;
}

}  // namespace lumibox::hal
