#include "render/blending.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lumibox::render {
namespace {

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

std::vector<double> wide_weights(const std::vector<double>& penalties, double limit,
                                 double exponent) {
  std::vector<double> weights;
  weights.reserve(penalties.size());
  double nearest = 0.0;
  for (const double penalty : penalties) {
    weights.push_back(limit > 0.0 ? std::max(0.0, 1.0 - penalty / limit) : 0.0);
    nearest = std::max(nearest, weights.back());
  }
  for (double& weight : weights) {
    // Relative to the nearest: near the limit a high power of all of them would be 0.
    if (nearest > 0.0) weight /= nearest;
    weight = std::pow(weight, std::max(0.0, exponent));
  }
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) {
    weight = sum > 0.0 ? weight / sum : 1.0 / static_cast<double>(weights.size());
  }
  return weights;
}

double limit_beyond(const std::vector<double>& penalties) {
  if (penalties.empty()) return 0.0;
  const auto n = static_cast<double>(penalties.size());
  return penalties.back() * std::sqrt((n + 1.0) / n);
}

double small_alpha(std::size_t rank, std::size_t k, double alpha) {
  if (rank == 0) return 1.0;
  if (rank >= k) return 0.0;
  const auto from_farthest = static_cast<double>(k - 1 - rank);
  const auto half = static_cast<double>(k / 2);
  return alpha * std::min(1.0, from_farthest / half);
}

double least_total_weight(std::size_t layers, bool on_shape) {
  return (on_shape ? 0.05 : 0.5) / static_cast<double>(std::max<std::size_t>(layers, 1));
}

double feather_width(int width, int height, double feather_px) {
  const double quarter = 0.25 * std::min(width, height);
  return std::max(1e-3, std::min(feather_px, quarter));  // a zero would divide by zero
}

double feather(const Eigen::Vector2d& pixel, int width, int height, double feather_px) {
  const double size = feather_width(width, height, feather_px);
  const double from_side = std::min(pixel.x(), width - 1.0 - pixel.x());
  const double from_edge = std::min(pixel.y(), height - 1.0 - pixel.y());
  return smooth_step(from_side / size) * smooth_step(from_edge / size);
}

}  // namespace lumibox::render
