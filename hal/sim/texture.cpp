#include "hal/sim/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lumibox::hal::sim {
namespace {

LinearImage halved(const LinearImage& fine) {
  const int step_x = fine.width > 1 ? 2 : 1;
  const int step_y = fine.height > 1 ? 2 : 1;
  LinearImage coarse(fine.width / step_x, fine.height / step_y);
  for (int y = 0; y < coarse.height; ++y) {
    const Color* upper = fine.row(y * step_y);
    const Color* lower = fine.row(y * step_y + step_y - 1);
    for (int x = 0; x < coarse.width; ++x) {
      const int left = x * step_x;
      const int right = left + step_x - 1;
      coarse.row(y)[x] = 0.25f * (upper[left] + upper[right] + lower[left] + lower[right]);
    }
  }
  return coarse;
}

/// std::floor is a library call on processors of the baseline; |x| must be below 2^31.
int floor_to_int(float x) {
  const int truncated = static_cast<int>(x);
  return truncated - (x < static_cast<float>(truncated) ? 1 : 0);
}

/// Logarithm to base 2 of x >= 1, exact at powers of two and linear between: what blends levels
/// evenly.
float log2_piecewise(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const auto exponent = static_cast<int>(bits >> 23) - 127;
  const float mantissa = std::bit_cast<float>((bits & 0x007fffffu) | 0x3f800000u);
  return static_cast<float>(exponent) + (mantissa - 1.0f);
}

}  // namespace

Texture::Texture(const LinearImage& base)
    : linear_(linear_from_srgb_byte_table()),
      base_texels_(static_cast<float>(std::max(base.width, base.height))) {
  LinearImage image = base;
  while (true) {
    Level level{image.width, image.height, {}};
    level.texels.reserve(image.pixels.size());
    for (const Color& c : image.pixels) {
      level.texels.push_back({srgb_byte_from_linear(c[0]), srgb_byte_from_linear(c[1]),
                              srgb_byte_from_linear(c[2]), 0});
    }
    levels_.push_back(std::move(level));
    if (image.width == 1 && image.height == 1) break;
    image = halved(image);
  }
}

Color Texture::bilinear(const Level& level, float u, float v) const {
  const float x = u * static_cast<float>(level.width) - 0.5f;
  const float y = v * static_cast<float>(level.height) - 0.5f;
  const int column = floor_to_int(x);
  const int row = floor_to_int(y);
  const float fx = x - static_cast<float>(column);
  const float fy = y - static_cast<float>(row);
  // Sizes are powers of two: masking repeats the tile, to negative coordinates too.
  const int x0 = column & (level.width - 1);
  const int y0 = row & (level.height - 1);
  const int x1 = (column + 1) & (level.width - 1);
  const int y1 = (row + 1) & (level.height - 1);

  const float* linear = linear_.data();
  const auto* upper = level.texels.data() + static_cast<std::ptrdiff_t>(y0) * level.width;
  const auto* lower = level.texels.data() + static_cast<std::ptrdiff_t>(y1) * level.width;
  Color result;
  for (std::size_t c = 0; c < 3; ++c) {
    const float top = linear[upper[x0][c]] + fx * (linear[upper[x1][c]] - linear[upper[x0][c]]);
    const float low = linear[lower[x0][c]] + fx * (linear[lower[x1][c]] - linear[lower[x0][c]]);
    result[static_cast<Eigen::Index>(c)] = top + fy * (low - top);
  }
  return result;
}

Color Texture::sample(float u, float v, float footprint) const {
  if (!(std::abs(u) < 1e5f && std::abs(v) < 1e5f)) return Color::Zero();
  const float level = log2_piecewise(std::max(footprint * base_texels_, 1.0f));
  const auto last = levels_.size() - 1;
  const auto fine = static_cast<std::size_t>(level);
  if (fine >= last) return bilinear(levels_[last], u, v);
  const float blend = level - static_cast<float>(fine);
  const Color near = bilinear(levels_[fine], u, v);
  return near + blend * (bilinear(levels_[fine + 1], u, v) - near);
}

}  // namespace lumibox::hal::sim
