#include "geometry/robust.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lumibox::geometry {

double tukey_weight(double residual, double limit) {
  if (!(std::abs(residual) < limit)) return 0.0;
  const double ratio = residual / limit;
  const double root = 1.0 - ratio * ratio;
  return root * root;
}

double huber_weight(double residual, double limit) {
  const double magnitude = std::abs(residual);
  return magnitude <= limit ? 1.0 : limit / magnitude;
}

double upper_median(std::span<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median(std::vector<double> values) {
  const double middle = upper_median(values);
  if (values.empty() || values.size() % 2 == 1) return middle;
  const double below = *std::max_element(
      values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return below + 0.5 * (middle - below);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const double rank = std::ceil(share * static_cast<double>(values.size())) - 1.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 0.0));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double mad_sigma(std::span<const double> residuals) {
  std::vector<double> magnitudes(residuals.size());
  std::transform(residuals.begin(), residuals.end(), magnitudes.begin(),
                 [](double r) { return std::abs(r); });
  return 1.4826 * median(std::move(magnitudes));
}

}  // namespace lumibox::geometry
