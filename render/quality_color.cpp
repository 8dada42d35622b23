#include "render/quality_color.h"

#include <algorithm>
#include <cmath>

namespace lumibox::render {
namespace {

// Photographs of a fox and a carton, as docs/guidance.md has them, lie between.
constexpr double kMiddle = 26.0;  // dB
constexpr double kSpan = 8.0;     // dB to either end of the scale

constexpr Color kOrange{0.95F, 0.45F, 0.0F, 1.0F};
constexpr Color kWhite{1.0F, 1.0F, 1.0F, 1.0F};
constexpr Color kBlue{0.15F, 0.5F, 1.0F, 1.0F};
constexpr Color kGrey{0.6F, 0.6F, 0.6F, 1.0F};

Color mixed(const Color& from, const Color& to, float t) {
  return {std::lerp(from.r, to.r, t), std::lerp(from.g, to.g, t), std::lerp(from.b, to.b, t), 1.0F};
}

}  // namespace

Color color_of_quality(std::optional<double> psnr) {
  if (!psnr) return kGrey;
  const auto t = static_cast<float>(std::clamp((*psnr - kMiddle) / kSpan, -1.0, 1.0));
  return t < 0.0F ? mixed(kWhite, kOrange, -t) : mixed(kWhite, kBlue, t);
}

}  // namespace lumibox::render
