#include "tracking/patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "hal/newer_processors.h"

namespace lumibox::tracking {
namespace {

constexpr int kArea = kPatch * kPatch;
constexpr double kCenter = 0.5 * (kPatch - 1);  // offset of the centre from the first pixel
constexpr float kGainUnit = 0.02F;  // of the gain's parameter: its column is then like the others
constexpr float kMinGain = 0.1F;    // of the picture's contrast to the template's
constexpr float kMaxGain = 10.0F;
constexpr int kMinVariance = 6 * kArea;  // grey levels squared, summed: contrast of 2.5 levels

float bilinear(const hal::Image& image, float x, float y) {
  // Rounded to float, a place inside may lie on the last pixel, which has no neighbour.
  const int x0 = std::min(static_cast<int>(x), image.width() - 2);
  const int y0 = std::min(static_cast<int>(y), image.height() - 2);
  const float ax = x - static_cast<float>(x0);
  const float ay = y - static_cast<float>(y0);
  const std::uint8_t* above = image.row(y0) + x0;
  const std::uint8_t* below = above + image.width();
  const float top = static_cast<float>(above[0]) + ax * static_cast<float>(above[1] - above[0]);
  const float bottom = static_cast<float>(below[0]) + ax * static_cast<float>(below[1] - below[0]);
  return top + ay * (bottom - top);
}

bool inside(const hal::Image& image, double x, double y) {
  return x >= 0.0 && y >= 0.0 && x < image.width() - 1 && y < image.height() - 1;
}

/// kArea^2 times the covariance of template and picture, and the same for the picture's variance.
struct Moments {
  std::int64_t covariance = 0;
  std::int64_t variance = 0;
};

/// `pixels` is the picture at the patch's first pixel. Sixteen-bit numbers, whose products the
/// processor adds up in pairs.
Moments moments_of(const std::int16_t* pixels, std::ptrdiff_t stride, const PatchTemplate& patch) {
  int sum = 0;
  int sum_squared = 0;
  int sum_product = 0;
  for (int v = 0; v < kPatch; ++v) {
    const std::int16_t* row = pixels + v * stride;
    const std::int16_t* wanted = patch.core.data() + v * kPatch;
    for (int u = 0; u < kPatch; ++u) {
      sum += row[u];
      sum_squared += int{row[u]} * int{row[u]};
      sum_product += int{row[u]} * int{wanted[u]};
    }
  }
  return {std::int64_t{kArea} * sum_product - std::int64_t{sum} * patch.sum,
          std::int64_t{kArea} * sum_squared - std::int64_t{sum} * sum};
}

Moments moments_at(const hal::Image& image, const PatchTemplate& patch, int x, int y) {
  std::array<std::int16_t, kArea> pixels;
  for (int v = 0; v < kPatch; ++v) {
    std::copy_n(image.row(y + v) + x, kPatch, pixels.data() + v * kPatch);
  }
  return moments_of(pixels.data(), kPatch, patch);
}

std::int64_t template_variance(const PatchTemplate& patch) {
  return std::int64_t{kArea} * patch.sum_squared - std::int64_t{patch.sum} * patch.sum;
}

double correlation(const Moments& moments, const PatchTemplate& patch) {
  if (moments.variance < std::int64_t{kArea} * kMinVariance / 4) return -1.0;
  return static_cast<double>(moments.covariance) /
         std::sqrt(static_cast<double>(moments.variance) *
                   static_cast<double>(template_variance(patch)));
}

bool patch_fits(const hal::Image& image, int x, int y) {
  return x >= 0 && y >= 0 && x + kPatch <= image.width() && y + kPatch <= image.height();
}

/// Gradient of the template and the normal equations of alignment with parameters
/// (dx, dy, offset, gain), the same in every iteration.
struct AlignmentSystem {
  std::array<Eigen::Vector4f, kArea> jacobian;
  Eigen::Matrix4f inverse_hessian;
  bool solvable = false;
};

AlignmentSystem make_system(const PatchTemplate& patch) {
  AlignmentSystem system;
  const float mean = static_cast<float>(patch.sum) / kArea;
  Eigen::Matrix4f hessian = Eigen::Matrix4f::Zero();
  for (int v = 0; v < kPatch; ++v) {
    for (int u = 0; u < kPatch; ++u) {
      const float* at = patch.values.data() + (v + 1) * PatchTemplate::kSide + u + 1;
      const Eigen::Vector4f j(0.5F * (at[1] - at[-1]),
                              0.5F * (at[PatchTemplate::kSide] - at[-PatchTemplate::kSide]), 1.0F,
                              (at[0] - mean) * kGainUnit);
      system.jacobian[static_cast<std::size_t>(v * kPatch + u)] = j;
      hessian.noalias() += j * j.transpose();
    }
  }
  const float determinant = hessian.topLeftCorner<2, 2>().determinant();
  system.solvable = determinant > 1.0F;
  if (system.solvable) system.inverse_hessian = hessian.inverse();
  return system;
}

}  // namespace

LUMIBOX_FOR_NEWER_PROCESSORS
std::optional<PatchTemplate> make_template(const hal::Image& image, const Eigen::Vector2d& center,
                                           const Eigen::Matrix2d& source_from_target) {
  constexpr double kReach = kCenter + 1.0;
  const Eigen::Vector2d reach = source_from_target.cwiseAbs() * Eigen::Vector2d(kReach, kReach);
  if (!inside(image, center.x() - reach.x(), center.y() - reach.y()) ||
      !inside(image, center.x() + reach.x(), center.y() + reach.y())) {
    return std::nullopt;
  }
  PatchTemplate patch;
  const Eigen::Matrix2f step = source_from_target.cast<float>();
  const Eigen::Vector2f origin =
      (center - source_from_target * Eigen::Vector2d(kReach, kReach)).cast<float>();
  for (int v = 0; v < PatchTemplate::kSide; ++v) {
    for (int u = 0; u < PatchTemplate::kSide; ++u) {
      const float x =
          origin.x() + step(0, 0) * static_cast<float>(u) + step(0, 1) * static_cast<float>(v);
      const float y =
          origin.y() + step(1, 0) * static_cast<float>(u) + step(1, 1) * static_cast<float>(v);
      patch.values[static_cast<std::size_t>(v * PatchTemplate::kSide + u)] =
          bilinear(image, std::max(x, 0.0F), std::max(y, 0.0F));
    }
  }
  for (int v = 0; v < kPatch; ++v) {
    for (int u = 0; u < kPatch; ++u) {
      const float value =
          patch.values[static_cast<std::size_t>((v + 1) * PatchTemplate::kSide + u + 1)];
      const int rounded = static_cast<int>(value + 0.5F);
      patch.core[static_cast<std::size_t>(v * kPatch + u)] = static_cast<std::int16_t>(rounded);
      patch.sum += rounded;
      patch.sum_squared += rounded * rounded;
    }
  }
  if (template_variance(patch) < std::int64_t{kArea} * kMinVariance) return std::nullopt;
  return patch;
}

LUMIBOX_FOR_NEWER_PROCESSORS
std::optional<PatchMatch> search_square(const hal::Image& image, const PatchTemplate& patch,
                                        const Eigen::Vector2d& center, double radius) {
  const int x_first = std::max(0, static_cast<int>(std::ceil(center.x() - kCenter - radius)));
  const int y_first = std::max(0, static_cast<int>(std::ceil(center.y() - kCenter - radius)));
  const int x_last =
      std::min(image.width() - kPatch, static_cast<int>(std::floor(center.x() - kCenter + radius)));
  const int y_last = std::min(image.height() - kPatch,
                              static_cast<int>(std::floor(center.y() - kCenter + radius)));
  if (x_last < x_first || y_last < y_first) return std::nullopt;
  // The whole window once as sixteen-bit numbers.
  const std::ptrdiff_t stride = x_last - x_first + kPatch;
  std::vector<std::int16_t> window(static_cast<std::size_t>(stride * (y_last - y_first + kPatch)));
  for (int y = y_first; y < y_last + kPatch; ++y) {
    std::copy_n(image.row(y) + x_first, stride, window.data() + (y - y_first) * stride);
  }
  // Comparing cov|cov|/var orders places as the correlation does, without its square root.
  double best_score = -std::numeric_limits<double>::infinity();
  PatchMatch best;
  Moments best_moments;
  for (int y = y_first; y <= y_last; ++y) {
    for (int x = x_first; x <= x_last; ++x) {
      const Moments m =
          moments_of(window.data() + (y - y_first) * stride + (x - x_first), stride, patch);
      if (m.variance < std::int64_t{kArea} * kMinVariance / 4) continue;
      const double covariance = static_cast<double>(m.covariance);
      const double score = covariance * std::abs(covariance) / static_cast<double>(m.variance);
      if (score > best_score) {
        best_score = score;
        best.pixel = Eigen::Vector2d(x + kCenter, y + kCenter);
        best_moments = m;
      }
    }
  }
  if (best_score == -std::numeric_limits<double>::infinity()) return std::nullopt;
  best.correlation = correlation(best_moments, patch);
  return best;
}

std::optional<double> correlation_at(const hal::Image& image, const PatchTemplate& patch,
                                     const Eigen::Vector2d& center) {
  const int x = static_cast<int>(std::lround(center.x() - kCenter));
  const int y = static_cast<int>(std::lround(center.y() - kCenter));
  if (!patch_fits(image, x, y)) return std::nullopt;
  return correlation(moments_at(image, patch, x, y), patch);
}

LUMIBOX_FOR_NEWER_PROCESSORS
std::optional<Eigen::Vector2d> align_patch(const hal::Image& image, const PatchTemplate& patch,
                                           const Eigen::Vector2d& start) {
  const AlignmentSystem system = make_system(patch);
  if (!system.solvable) return std::nullopt;
  Eigen::Vector2d position = start;
  float offset = 0.0F;
  float gain = 0.0F;
  const float mean = static_cast<float>(patch.sum) / kArea;
  for (int iteration = 0; iteration < 10; ++iteration) {
    const double left = position.x() - kCenter;
    const double top = position.y() - kCenter;
    if (!inside(image, left, top) || !inside(image, left + kPatch - 1, top + kPatch - 1)) {
      return std::nullopt;
    }
    const int x0 = static_cast<int>(left);
    const int y0 = static_cast<int>(top);
    const float ax = static_cast<float>(left - x0);
    const float ay = static_cast<float>(top - y0);
    const float w00 = (1.0F - ax) * (1.0F - ay), w01 = ax * (1.0F - ay);
    const float w10 = (1.0F - ax) * ay, w11 = ax * ay;
    Eigen::Vector4f gradient = Eigen::Vector4f::Zero();
    for (int v = 0; v < kPatch; ++v) {
      const std::uint8_t* above = image.row(y0 + v) + x0;
      const std::uint8_t* below = above + image.width();
      const float* wanted = patch.values.data() + (v + 1) * PatchTemplate::kSide + 1;
      for (int u = 0; u < kPatch; ++u) {
        const float value =
            w00 * static_cast<float>(above[u]) + w01 * static_cast<float>(above[u + 1]) +
            w10 * static_cast<float>(below[u]) + w11 * static_cast<float>(below[u + 1]);
        const float predicted = wanted[u] + offset + gain * (wanted[u] - mean) * kGainUnit;
        gradient += system.jacobian[static_cast<std::size_t>(v * kPatch + u)] * (value - predicted);
      }
    }
    const Eigen::Vector4f step = system.inverse_hessian * gradient;
    offset += step.z();
    gain += step.w();
    // The picture's gradient is the template's times the gain: without this an exposure that has
    // doubled since the template makes every step twice as long as it should be.
    const float contrast = 1.0F + kGainUnit * gain;
    if (!(contrast > kMinGain && contrast < kMaxGain)) return std::nullopt;
    position.x() -= static_cast<double>(step.x() / contrast);
    position.y() -= static_cast<double>(step.y() / contrast);
    if (!((position - start).squaredNorm() < 4.0)) return std::nullopt;
    if (step.head<2>().squaredNorm() < 0.01F * 0.01F) return position;
  }
  return std::nullopt;
}

}  // namespace lumibox::tracking
