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

std::size_t as_index(int i) {
  return static_cast<std::size_t>(i);
}

/// Where the bits of 0 ... size - 1 come to lie when they take turns with the bits of the numbers
/// below `other_size`; `second` takes the later turn. Both are powers of two.
std::vector<std::uint32_t> interleaved(int size, int other_size, bool second) {
  std::vector<std::uint32_t> places(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) {
    std::uint32_t place = 0;
    for (int bit = 0, at = 0; (1 << bit) < size; ++bit) {
      const bool other_first = second && (1 << bit) < other_size;
      if (other_first) ++at;
      place |= ((static_cast<std::uint32_t>(i) >> bit) & 1u) << at++;
      if (!second && (1 << bit) < other_size) ++at;
    }
    places[static_cast<std::size_t>(i)] = place;
  }
  return places;
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
  Level level{image.width, image.height, interleaved(image.width, image.height, false),
              interleaved(image.height, image.width, true),
              std::vector<Texel>(image.pixels.size())};
  for (int y = 0; y < image.height; ++y) {
    Texel* row = level.texels.data() + level.row_place[static_cast<std::size_t>(y)];
    for (int x = 0; x < image.width; ++x) {
      const Color& c = image.row(y)[x];
      row[level.column_place[static_cast<std::size_t>(x)]] =
          Texel{narrowed(c[0]), narrowed(c[1]), narrowed(c[2]), 0};
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
  const float x = u * static_cast<float>(level.width) - 0.5f;
  const float y = v * static_cast<float>(level.height) - 0.5f;
  const int column = floor_to_int(x);
  const int row = floor_to_int(y);
  const float fx = x - static_cast<float>(column);
  const float fy = y - static_cast<float>(row);
  // Sizes are powers of two: masking repeats the tile, to negative coordinates too.
  const std::uint32_t x0 = level.column_place[as_index(column & (level.width - 1))];
  const std::uint32_t x1 = level.column_place[as_index((column + 1) & (level.width - 1))];
  const Texel* upper = level.texels.data() + level.row_place[as_index(row & (level.height - 1))];
  const Texel* lower =
      level.texels.data() + level.row_place[as_index((row + 1) & (level.height - 1))];

  const Float4 left = floats(upper[x0]) + fy * (floats(lower[x0]) - floats(upper[x0]));
  const Float4 right = floats(upper[x1]) + fy * (floats(lower[x1]) - floats(upper[x1]));
  return left + fx * (right - left);
}

Float4 Texture::sample(float u, float v, float footprint) const {
  if (!(std::abs(u) < 1e5f && std::abs(v) < 1e5f)) return Float4{};
  const float level = log2_piecewise(std::max(footprint * base_texels_, 1.0f));
  const auto last = levels_.size() - 1;
  const auto fine = std::min(static_cast<std::size_t>(level), last);
  Float4 color = bilinear(levels_[fine], u, v);
  if (fine < last) {
    const float blend = level - static_cast<float>(fine);
    color += blend * (bilinear(levels_[fine + 1], u, v) - color);
  }
  return color * (1.0f / 65535.0f);
}

}  // namespace lumibox::hal::sim
