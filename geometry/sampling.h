#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

namespace lumibox::geometry {

/// Draws samples for RANSAC. The standard fixes std::mt19937 but not the distributions, so the
/// reduction to a range is our own: the same seed gives the same samples with every library.
class Sampler {
 public:
  explicit Sampler(std::uint32_t seed) : generator_(seed) {}

  /// N different indices below `count`, which must be at least N.
  template <std::size_t N>
  std::array<std::size_t, N> draw(std::size_t count) {
    std::array<std::size_t, N> sample{};
    for (std::size_t i = 0; i < N; ++i) {
      bool repeated = true;
      while (repeated) {
        sample[i] = below(count);
        repeated = false;
        for (std::size_t j = 0; j < i; ++j) repeated |= sample[j] == sample[i];
      }
    }
    return sample;
  }

 private:
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>((std::uint64_t{generator_()} * count) >> 32);
  }

  std::mt19937 generator_;
};

/// Number of samples of `sample_size` after which one free of outliers was drawn with probability
/// 99.9 %, at most `limit` (Fischler and Bolles, 1981).
inline int samples_needed(double inlier_fraction, std::size_t sample_size, int limit) {
  const double good = std::pow(inlier_fraction, static_cast<double>(sample_size));
  if (good >= 0.999) return 1;
  if (good < 1e-9) return limit;
  const double needed = std::ceil(std::log(0.001) / std::log1p(-good));
  return needed < limit ? static_cast<int>(needed) : limit;
}

}  // namespace lumibox::geometry
