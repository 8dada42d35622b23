#include "hal/sim/noise.h"

#include <cmath>

#include "hal/sim/random.h"

namespace lumibox::hal::sim {
namespace {

template <typename T>
T smoothstep(T x) {
  return x * x * (T(3) - T(2) * x);
}

double value_noise(const Eigen::Vector3d& p, std::uint64_t seed) {
  const Eigen::Vector3d floor = p.array().floor();
  const Eigen::Vector3d f = p - floor;
  const auto x = static_cast<std::int64_t>(floor.x());
  const auto y = static_cast<std::int64_t>(floor.y());
  const auto z = static_cast<std::int64_t>(floor.z());
  const double wx = smoothstep(f.x());
  const auto along_x = [&](std::int64_t yy, std::int64_t zz) {
    return std::lerp(static_cast<double>(lattice_value(seed, x, yy, zz)),
                     static_cast<double>(lattice_value(seed, x + 1, yy, zz)), wx);
  };
  const double wy = smoothstep(f.y());
  const double near = std::lerp(along_x(y, z), along_x(y + 1, z), wy);
  const double far = std::lerp(along_x(y, z + 1), along_x(y + 1, z + 1), wy);
  return std::lerp(near, far, smoothstep(f.z()));
}

/// Adds weight * (periodic value noise) to a grid.
void add_octave(std::vector<float>& grid, int width, int height, int cells_x, int cells_y,
                float weight, std::uint64_t seed) {
  std::vector<int> left(static_cast<std::size_t>(width));
  std::vector<float> blend(static_cast<std::size_t>(width));
  for (int x = 0; x < width; ++x) {
    const float at =
        static_cast<float>(x) * static_cast<float>(cells_x) / static_cast<float>(width);
    left[static_cast<std::size_t>(x)] = static_cast<int>(at);
    blend[static_cast<std::size_t>(x)] = smoothstep(at - std::floor(at));
  }
  std::vector<float> lattice(static_cast<std::size_t>(cells_x + 1));
  for (int y = 0; y < height; ++y) {
    const float at =
        static_cast<float>(y) * static_cast<float>(cells_y) / static_cast<float>(height);
    const int top = static_cast<int>(at);
    const float wy = smoothstep(at - std::floor(at));
    for (int i = 0; i <= cells_x; ++i) {
      const float upper = lattice_value(seed, i % cells_x, top % cells_y);
      const float lower = lattice_value(seed, i % cells_x, (top + 1) % cells_y);
      lattice[static_cast<std::size_t>(i)] = weight * (upper + wy * (lower - upper));
    }
    float* row = grid.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(left[static_cast<std::size_t>(x)]);
      row[x] += lattice[i] + blend[static_cast<std::size_t>(x)] * (lattice[i + 1] - lattice[i]);
    }
  }
}

}  // namespace

double fractal_noise(const Eigen::Vector3d& point, double cell, int octaves, std::uint64_t seed) {
  double sum = 0.0;
  double total = 0.0;
  double weight = 1.0;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += weight * value_noise(point / cell, seed + static_cast<std::uint64_t>(octave));
    total += weight;
    weight *= 0.5;
    cell *= 0.5;
  }
  return total > 0.0 ? sum / total : 0.5;
}

std::vector<float> fractal_noise_tile(int width, int height, int cells_x, int cells_y, int octaves,
                                      float gain, std::uint64_t seed) {
  std::vector<float> weights;
  float total = 0.0f;
  for (int octave = 0; octave < octaves; ++octave) {
    if ((cells_x << octave) > width / 2 || (cells_y << octave) > height / 2) break;
    weights.push_back(octave == 0 ? 1.0f : weights.back() * gain);
    total += weights.back();
  }
  std::vector<float> grid(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                          weights.empty() ? 0.5f : 0.0f);
  for (std::size_t octave = 0; octave < weights.size(); ++octave) {
    add_octave(grid, width, height, cells_x << octave, cells_y << octave, weights[octave] / total,
               seed + octave);
  }
  return grid;
}

}  // namespace lumibox::hal::sim
