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

std::uint8_t srgb_byte_from_linear(float linear) {
  // Fine enough that the steepest part of the curve, at black, moves by 0.2 levels per entry.
  constexpr int kSteps = 1 << 14;
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> bytes(kSteps + 1);
    for (int i = 0; i <= kSteps; ++i) {
      const float srgb = srgb_from_linear(static_cast<float>(i) / kSteps);
      bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(srgb * 255.0f + 0.5f);
    }
    return bytes;
  }();
  // Written so that NaN becomes black.
  const float clamped = linear > 0.0f ? std::min(linear, 1.0f) : 0.0f;
  return table[static_cast<std::size_t>(clamped * kSteps + 0.5f)];
}

}  // namespace lumibox::hal::sim
