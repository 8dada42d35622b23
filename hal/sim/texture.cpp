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

/// Steps that a texel is divided into: a whole number of them splits into texel and fraction
/// without a branch.
constexpr int kStepBits = 8;
constexpr float kSteps = 1 << kStepBits;

/// Between texel centres: index of the lower one, to be wrapped, and how far beyond it.
struct Position {
  std::uint32_t index;
  float fraction;
};
Position position(float tiles, float texels_per_tile) {
  const auto steps =
      static_cast<std::int64_t>(std::lrint((tiles * texels_per_tile - 0.5f) * kSteps));
  return {static_cast<std::uint32_t>(steps >> kStepBits),
          static_cast<float>(steps & ((1 << kStepBits) - 1)) * (1.0f / kSteps)};
}

/// Logarithm to base 2 of x >= 1, exact at powers of two and linear between: what blends levels
/// evenly.
float log2_piecewise(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const auto exponent = static_cast<int>(bits >> 23) - 127;
  const float mantissa = std::bit_cast<float>((bits & 0x007fffffu) | 0x3f800000u);
  return static_cast<float>(exponent) + (mantissa - 1.0f);
}

/// Weight of the coarser of two levels, from how far the wanted one lies between them. Near a level
/// that level alone will do: half of all look-ups are spared the other.
float blend_of(float fraction) {
  return std::clamp(2.0f * fraction - 0.5f, 0.0f, 1.0f);
}

}  // namespace

Texture::Texture(const LinearImage& base)
    : base_texels_(static_cast<float>(std::max(base.width, base.height))) {
  LinearImage image = base;
  levels_.push_back(level_of(image));
  while (image.width > 1 || image.height > 1) {
    image = halved(image);
    levels_.push_back(level_of(image));
  }
}

Texture::Level Texture::level_of(const LinearImage& image) {
  const auto narrowed = [](float linear) {
    return static_cast<std::uint16_t>(std::clamp(linear, 0.0f, 1.0f) * 65535.0f + 0.5f);
  };
  Level level;
  level.width = static_cast<std::uint32_t>(image.width);
  level.height = static_cast<std::uint32_t>(image.height);
  level.blocks_per_row = (level.width + 3) / 4;
  level.texels.resize(std::size_t{16} * level.blocks_per_row * ((level.height + 3) / 4));
  for (std::uint32_t y = 0; y < level.height; ++y) {
    const Color* row = image.row(static_cast<int>(y));
    for (std::uint32_t x = 0; x < level.width; ++x) {
      level.texels[level.row_place(y) + Level::column_place(x)] =
          Texel{narrowed(row[x][0]), narrowed(row[x][1]), narrowed(row[x][2]), 0};
    }
  }
  return level;
}

Float4 Texture::floats(const Texel& texel) {
  // By way of int: processors convert only that to float.
  using Int4 = int __attribute__((vector_size(16)));
  return __builtin_convertvector(__builtin_convertvector(texel, Int4), Float4);
}

Float4 Texture::bilinear(const Level& level, float u, float v) {
  const auto [column, fx] = position(u, static_cast<float>(level.width));
  const auto [row, fy] = position(v, static_cast<float>(level.height));
  // Sizes are powers of two: masking repeats the tile, to negative coordinates too.
  const std::uint32_t x0 = Level::column_place(column & (level.width - 1));
  const std::uint32_t x1 = Level::column_place((column + 1) & (level.width - 1));
  const Texel* upper = level.texels.data() + level.row_place(row & (level.height - 1));
  const Texel* lower = level.texels.data() + level.row_place((row + 1) & (level.height - 1));
  const Float4 upper_left = floats(upper[x0]);
  const Float4 upper_right = floats(upper[x1]);
  const Float4 lower_left = floats(lower[x0]);
  const Float4 lower_right = floats(lower[x1]);
  const Float4 left = upper_left + fy * (lower_left - upper_left);
  const Float4 right = upper_right + fy * (lower_right - upper_right);
  return left + fx * (right - left);
}

Float4 Texture::sample(float u, float v, float footprint) const {
  if (!(std::abs(u) < 1e5f && std::abs(v) < 1e5f)) return Float4{};
  const float level = log2_piecewise(std::max(footprint * base_texels_, 1.0f));
  const auto last = levels_.size() - 1;
  const auto fine = std::min(static_cast<std::size_t>(level), last);
  const float blend = fine < last ? blend_of(level - static_cast<float>(fine)) : 0.0f;
  Float4 color = bilinear(levels_[blend < 1.0f ? fine : fine + 1], u, v);
  if (blend > 0.0f && blend < 1.0f) {
    color += blend * (bilinear(levels_[fine + 1], u, v) - color);
  }
  return color * (1.0f / 65535.0f);
}

}  // namespace lumibox::hal::sim
