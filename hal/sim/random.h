#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace lumibox::hal::sim {

/// Scrambles 64 bits (the finaliser of splitmix64, Steele et al., OOPSLA 2014). Equal on every
/// machine, unlike the distributions of <random>.
constexpr std::uint64_t scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// A number in [0, 1) that belongs to a lattice point.
constexpr float lattice_value(std::uint64_t seed, std::int64_t x, std::int64_t y,
                              std::int64_t z = 0) {
  const std::uint64_t key = static_cast<std::uint64_t>(x) * 0x8da6b343ULL +
                            static_cast<std::uint64_t>(y) * 0xd8163841ULL +
                            static_cast<std::uint64_t>(z) * 0xcb1ab31fULL;
  return static_cast<float>(scramble(seed ^ scramble(key)) >> 40) * 0x1p-24f;
}

/// A seeded stream of numbers.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(scramble(seed)) {}

  std::uint64_t bits() { return scramble(state_++); }

  /// In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// In [0, count); count > 0.
  int below(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }

  /// Standard normal (Box and Muller, 1958).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace lumibox::hal::sim
