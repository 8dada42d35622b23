#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace lumibox::hal::sim {

/// Value noise summed over octaves, each of half the cell and half the weight; in [0, 1], mean 0.5.
/// `cell` is the coarsest cell's edge in the unit of `point`.
double fractal_noise(const Eigen::Vector3d& point, double cell, int octaves, std::uint64_t seed);

/// The same sampled on a width x height grid that repeats without a seam: `cells_x`, `cells_y`
/// coarsest cells fit across it. `gain` is the weight of an octave relative to the next coarser
/// one. Octaves finer than two samples per cell are left out.
std::vector<float> fractal_noise_tile(int width, int height, int cells_x, int cells_y, int octaves,
                                      float gain, std::uint64_t seed);

}  // namespace lumibox::hal::sim
