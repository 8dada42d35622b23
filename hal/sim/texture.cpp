#include "hal/sim/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "hal/newer_processors.h"

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

// What follows takes no branch, not even to choose between two values: else compilers give up on
// making vector code of it.

/// The same place among the first tiles, where nothing is negative.
float without_tiles(float tiles) {
  const int is_near = std::abs(tiles) < 1e5f;
  const auto near = std::bit_cast<float>(std::bit_cast<std::int32_t>(tiles) & -is_near);
  return near - static_cast<float>(static_cast<int>(near)) + 2.0f;
}

int at_least_one(int count) {
  return count + static_cast<int>(count == 0);
}
int smaller(int a, int b) {
  return b ^ ((a ^ b) & -static_cast<int>(a < b));
}
int larger(int a, int b) {
  return a ^ ((a ^ b) & -static_cast<int>(a < b));
}

}  // namespace

Texture::Texture(const LinearImage& base)
    : width_(static_cast<float>(base.width)), height_(static_cast<float>(base.height)) {
  LinearImage image = base;
  add_level(image);
  while (image.width > 1 || image.height > 1) {
    image = halved(image);
    add_level(image);
  }
}

void Texture::add_level(const LinearImage& image) {
  const auto narrowed = [](float linear) {
    const float root = std::sqrt(std::clamp(linear, 0.0f, 1.0f));
    return static_cast<Texel>(root * static_cast<float>(kMost) + 0.5f);
  };
  const int blocks_per_row = (image.width + 3) / 4;
  const std::size_t first = texels_.size();
  first_[static_cast<std::size_t>(++last_level_)] = static_cast<std::int32_t>(first);
  texels_.resize(first + static_cast<std::size_t>(16 * blocks_per_row * ((image.height + 3) / 4)));
  for (int y = 0; y < image.height; ++y) {
    const Color* row = image.row(y);
    for (int x = 0; x < image.width; ++x) {
      const int block = y / 4 * blocks_per_row + x / 4;
      texels_[first + static_cast<std::size_t>(16 * block + y % 4 * 4 + x % 4)] =
          narrowed(row[x][0]) | narrowed(row[x][1]) << kBits | narrowed(row[x][2]) << (2 * kBits);
    }
  }
}

Texture::Corners Texture::corners(const Places& places, const Ints& level) const {
  Corners result;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const float scale = std::bit_cast<float>((127 - level[i]) << 23);  // 2^-level
    const int columns = at_least_one(static_cast<int>(width_ * scale));
    const int rows = at_least_one(static_cast<int>(height_ * scale));
    const float x = without_tiles(places.u[i]) * static_cast<float>(columns) - 0.5f;
    const float y = without_tiles(places.v[i]) * static_cast<float>(rows) - 0.5f;
    const int x_steps = static_cast<int>(x * (1 << kStepBits) + 0.5f);
    const int y_steps = static_cast<int>(y * (1 << kStepBits) + 0.5f);
    constexpr int kFraction = (1 << kStepBits) - 1;
    result.x[i] = static_cast<float>(x_steps & kFraction) * (1.0f / (1 << kStepBits));
    result.y[i] = static_cast<float>(y_steps & kFraction) * (1.0f / (1 << kStepBits));
    // Sizes are powers of two: masking repeats the tile.
    const int left = (x_steps >> kStepBits) & (columns - 1);
    const int right = ((x_steps >> kStepBits) + 1) & (columns - 1);
    const int upper = (y_steps >> kStepBits) & (rows - 1);
    const int lower = ((y_steps >> kStepBits) + 1) & (rows - 1);
    const int block_row = 4 * at_least_one(columns / 4);
    const int left_place =
        (left >> 2) * 16 + (left & 3) + first_[static_cast<std::size_t>(level[i])];
    const int right_place =
        (right >> 2) * 16 + (right & 3) + first_[static_cast<std::size_t>(level[i])];
    const int upper_place = (upper & ~3) * block_row + (upper & 3) * 4;
    const int lower_place = (lower & ~3) * block_row + (lower & 3) * 4;
    result.texel[0][i] = upper_place + left_place;
    result.texel[1][i] = upper_place + right_place;
    result.texel[2][i] = lower_place + left_place;
    result.texel[3][i] = lower_place + right_place;
  }
  return result;
}

Texture::Colors Texture::bilinear(const Places& places, const Ints& level) const {
  const Corners at = corners(places, level);
  alignas(32) std::array<Ints, 4> texels;
  const Texel* memory = texels_.data();
  for (std::size_t corner = 0; corner < 4; ++corner) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      texels[corner][i] = static_cast<std::int32_t>(memory[at.texel[corner][i]]);
    }
  }
  Colors colors;
  const auto blend = [&](int shift, Floats& channel) {
    constexpr float kUnit = 1.0f / (kMost * kMost);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const auto light = [&](std::size_t corner) {
        const auto root =
            static_cast<float>((texels[corner][i] >> shift) & static_cast<std::int32_t>(kMost));
        return root * root;
      };
      const float upper = light(0) + at.x[i] * (light(1) - light(0));
      const float lower = light(2) + at.x[i] * (light(3) - light(2));
      channel[i] = (upper + at.y[i] * (lower - upper)) * kUnit;
    }
  };
  blend(0, colors.red);
  blend(kBits, colors.green);
  blend(2 * kBits, colors.blue);
  return colors;
}

// Nothing but loops over lanes, which compilers turn into vector instructions.
LUMIBOX_FOR_NEWER_PROCESSORS
Texture::Colors Texture::sample(const Places& places) const {
  alignas(32) Ints fine;
  alignas(32) Ints coarse;
  alignas(32) Floats share;  // of the coarser level
  const float most_texels = std::max(width_, height_);
  const std::int32_t last = last_level_;
  std::int32_t blended = 0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    // The bits of a float from 1 are, but for an offset, its logarithm to base 2 with 23 binary
    // places: exact at powers of two and linear between, which blends levels evenly.
    constexpr int kOne = 1 << 23;
    const auto bits = std::bit_cast<std::int32_t>(places.footprint[i] * most_texels);
    const int log2 = larger(bits - std::bit_cast<std::int32_t>(1.0f), 0);
    // Near a level that level alone will do: half of all look-ups are spared the other.
    const int wanted = smaller(larger(2 * (log2 & (kOne - 1)) - kOne / 2, 0), kOne);
    fine[i] = smaller((log2 >> 23) + (wanted >> 23), last);
    coarse[i] = smaller(fine[i] + 1, last);
    share[i] = static_cast<float>(wanted & (kOne - 1)) * (1.0f / kOne);
    blended |= wanted & (kOne - 1);
  }
  Colors colors = bilinear(places, fine);
  if (blended == 0) return colors;
  const Colors coarser = bilinear(places, coarse);
  for (std::size_t i = 0; i < kLanes; ++i) {
    colors.red[i] += share[i] * (coarser.red[i] - colors.red[i]);
    colors.green[i] += share[i] * (coarser.green[i] - colors.green[i]);
    colors.blue[i] += share[i] * (coarser.blue[i] - colors.blue[i]);
  }
  return colors;
}

}  // namespace lumibox::hal::sim
