#include "hal/sim/color.h"

namespace lumibox::hal::sim {

const std::array<float, 256>& linear_from_srgb_byte_table() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = linear_from_srgb(static_cast<float>(i) / 255.0f);
    }
    return values;
  }();
  return table;
}

const SrgbBytes& SrgbBytes::table() {
  static const SrgbBytes bytes;
  return bytes;
}

SrgbBytes::SrgbBytes() {
  for (int i = 0; i <= kSteps; ++i) {
    const float srgb = srgb_from_linear(static_cast<float>(i) / kSteps);
    bytes_[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(srgb * 255.0f + 0.5f);
  }
}

}  // namespace lumibox::hal::sim
