#include "tracking/patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "hal/newer_processors.h"

namespace lumibox::tracking {
namespace {

constexpr int kArea = kPatch * kPatch;
constexpr double kCenter = 0.5 * (kPatch - 1);  // offset of the centre from the first pixel
constexpr float kGainUnit = 0.02F;  // of the gain's parameter: its column is then like the others
constexpr float kMinGain = 0.1F;    // of the picture's contrast to the template's
constexpr float kMaxGain = 10.0F;
constexpr int kMinVariance = 6 * kArea;  // grey levels squared, summed: contrast of 2.5 levels

bool inside(const hal::Image& image, double x, double y) {
  return x >= 0.0 && y >= 0.0 && x < image.width() - 1 && y < image.height() - 1;
}

/// The picture at origin + step * (u, v) for the columns u and rows v of a template, bilinear. In
/// three passes, of which the processor does the first and the last on many samples at once.
void sample(const hal::Image& image, const Eigen::Vector2f& origin, const Eigen::Matrix2f& step,
            std::array<float, PatchTemplate::kSide * PatchTemplate::kSide>& values) {
  constexpr int kSide = PatchTemplate::kSide;
  constexpr std::size_t kCount = kSide * kSide;
  std::array<float, kCount> ax, ay, top_left, top_right, bottom_left, bottom_right;
  std::array<int, kCount> first;  // byte of the pixel above and to the left
  // Rounded to float, a place inside may lie on the last pixel, which has no neighbour, or before
  // the first.
  const int last_x = image.width() - 2;
  const int last_y = image.height() - 2;
  for (int v = 0; v < kSide; ++v) {
    const float row_x = origin.x() + step(0, 1) * static_cast<float>(v);
    const float row_y = origin.y() + step(1, 1) * static_cast<float>(v);
    for (int u = 0; u < kSide; ++u) {
      const float x = std::max(row_x + step(0, 0) * static_cast<float>(u), 0.0F);
      const float y = std::max(row_y + step(1, 0) * static_cast<float>(u), 0.0F);
      const int x0 = std::min(static_cast<int>(x), last_x);
      const int y0 = std::min(static_cast<int>(y), last_y);
      const std::size_t i = static_cast<std::size_t>(v * kSide + u);
      ax[i] = x - static_cast<float>(x0);
      ay[i] = y - static_cast<float>(y0);
      first[i] = y0 * image.width() + x0;
    }
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::uint8_t* above = image.data() + first[i];
    const std::uint8_t* below = above + image.width();
    top_left[i] = static_cast<float>(above[0]);
    top_right[i] = static_cast<float>(above[1]);
    bottom_left[i] = static_cast<float>(below[0]);
    bottom_right[i] = static_cast<float>(below[1]);
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    const float top = top_left[i] + ax[i] * (top_right[i] - top_left[i]);
    const float bottom = bottom_left[i] + ax[i] * (bottom_right[i] - bottom_left[i]);
    values[i] = top + ay[i] * (bottom - top);
  }
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

/// One number per column of the patch: sums are kept by column, so that the processor adds eight at
/// once, and in the same order on every processor.
using Columns = std::array<float, kPatch>;

float sum_of(const Columns& c) {
  return ((c[0] + c[4]) + (c[1] + c[5])) + ((c[2] + c[6]) + (c[3] + c[7]));
}

/// Gradient of the template and the normal equations of alignment with parameters
/// (dx, dy, offset, gain), the same in every iteration. The offset's column is 1 throughout.
struct AlignmentSystem {
  std::array<float, kArea> wanted;  ///< the template without its border
  std::array<float, kArea> dx;
  std::array<float, kArea> dy;
  std::array<float, kArea> gain;
  Eigen::Matrix4f inverse_hessian;
  bool solvable = false;
};

AlignmentSystem make_system(const PatchTemplate& patch) {
  AlignmentSystem system;
  const float mean = static_cast<float>(patch.sum) / kArea;
  Columns xx{}, xy{}, x{}, xg{}, yy{}, y{}, yg{}, g{}, gg{};
  for (int v = 0; v < kPatch; ++v) {
    const float* at = patch.values.data() + (v + 1) * PatchTemplate::kSide + 1;
    float* wanted = system.wanted.data() + v * kPatch;
    float* dx = system.dx.data() + v * kPatch;
    float* dy = system.dy.data() + v * kPatch;
    float* gain = system.gain.data() + v * kPatch;
    for (std::size_t u = 0; u < kPatch; ++u) {
      wanted[u] = at[u];
      dx[u] = 0.5F * (at[u + 1] - (at - 1)[u]);
      dy[u] = 0.5F * (at[u + PatchTemplate::kSide] - (at - PatchTemplate::kSide)[u]);
      gain[u] = (at[u] - mean) * kGainUnit;
      xx[u] += dx[u] * dx[u];
      xy[u] += dx[u] * dy[u];
      x[u] += dx[u];
      xg[u] += dx[u] * gain[u];
      yy[u] += dy[u] * dy[u];
      y[u] += dy[u];
      yg[u] += dy[u] * gain[u];
      g[u] += gain[u];
      gg[u] += gain[u] * gain[u];
    }
  }
  Eigen::Matrix4f hessian;
  hessian << sum_of(xx), sum_of(xy), sum_of(x), sum_of(xg),        //
      sum_of(xy), sum_of(yy), sum_of(y), sum_of(yg),               //
      sum_of(x), sum_of(y), static_cast<float>(kArea), sum_of(g),  //
      sum_of(xg), sum_of(yg), sum_of(g), sum_of(gg);
  const float determinant = hessian.topLeftCorner<2, 2>().determinant();
  system.solvable = determinant > 1.0F;
  if (system.solvable) system.inverse_hessian = hessian.inverse();
  return system;
}

/// Pixels of the picture around a patch that lies between them, as float.
struct Surroundings {
  static constexpr int kSide = kPatch + 1;
  std::array<float, kSide * kSide> values;
  int x = -1;
  int y = -1;

  void look_at(const hal::Image& image, int left, int top) {
    if (left == x && top == y) return;
    x = left;
    y = top;
    for (int v = 0; v < kSide; ++v) {
      const std::uint8_t* row = image.row(top + v) + left;
      float* out = values.data() + v * kSide;
      for (int u = 0; u < kSide; ++u) out[u] = static_cast<float>(row[u]);
    }
  }
};

/// Sums of the system's columns times the difference between picture and template, whose offset and
/// gain have been found so far; the patch lies (ax, ay) to the right of and below whole pixels.
Eigen::Vector4f gradient_of(const AlignmentSystem& system, const Surroundings& picture, float ax,
                            float ay, float offset, float gain) {
  const float w00 = (1.0F - ax) * (1.0F - ay), w01 = ax * (1.0F - ay);
  const float w10 = (1.0F - ax) * ay, w11 = ax * ay;
  Columns by_x{}, by_y{}, by_offset{}, by_gain{};
  for (int v = 0; v < kPatch; ++v) {
    const float* above = picture.values.data() + v * Surroundings::kSide;
    const float* below = above + Surroundings::kSide;
    const std::size_t row = static_cast<std::size_t>(v * kPatch);
    for (std::size_t u = 0; u < kPatch; ++u) {
      const float value = w00 * above[u] + w01 * above[u + 1] + w10 * below[u] + w11 * below[u + 1];
      const float error = value - (system.wanted[row + u] + offset + gain * system.gain[row + u]);
      by_x[u] += system.dx[row + u] * error;
      by_y[u] += system.dy[row + u] * error;
      by_offset[u] += error;
      by_gain[u] += system.gain[row + u] * error;
    }
  }
  return {sum_of(by_x), sum_of(by_y), sum_of(by_offset), sum_of(by_gain)};
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
  sample(image, origin, step, patch.values);
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
                                        const Eigen::Vector2d& center, double wanted_radius) {
  constexpr int kWindow = 2 * static_cast<int>(kMaxSearchRadius) + kPatch + 1;
  const double radius = std::min(wanted_radius, kMaxSearchRadius);
  const int x_first = std::max(0, static_cast<int>(std::ceil(center.x() - kCenter - radius)));
  const int y_first = std::max(0, static_cast<int>(std::ceil(center.y() - kCenter - radius)));
  const int x_last =
      std::min(image.width() - kPatch, static_cast<int>(std::floor(center.x() - kCenter + radius)));
  const int y_last = std::min(image.height() - kPatch,
                              static_cast<int>(std::floor(center.y() - kCenter + radius)));
  if (x_last < x_first || y_last < y_first) return std::nullopt;
  // The whole window once as sixteen-bit numbers.
  const std::ptrdiff_t stride = x_last - x_first + kPatch;
  std::array<std::int16_t, kWindow * kWindow> window;
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
  Surroundings picture;
  Eigen::Vector2d position = start;
  float offset = 0.0F;
  float gain = 0.0F;
  for (int iteration = 0; iteration < 10; ++iteration) {
    const double left = position.x() - kCenter;
    const double top = position.y() - kCenter;
    if (!inside(image, left, top) || !inside(image, left + kPatch - 1, top + kPatch - 1)) {
      return std::nullopt;
    }
    const int x0 = static_cast<int>(left);
    const int y0 = static_cast<int>(top);
    picture.look_at(image, x0, y0);
    const Eigen::Vector4f gradient = gradient_of(system, picture, static_cast<float>(left - x0),
                                                 static_cast<float>(top - y0), offset, gain);
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
