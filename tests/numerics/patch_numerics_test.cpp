#include <Eigen/LU>
#include <cmath>
#include <random>

#include "numerics/trap.h"
#include "tracking/patch.h"

namespace lumibox::tracking {
namespace {

using PatchNumerics = Trapped;

hal::Image textured(int width, int height) {
  hal::Image image(width, height, 1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double value = 128.0 + 45.0 * std::sin(0.55 * x + 0.2 * y) +
                           40.0 * std::cos(0.13 * x - 0.48 * y) + 20.0 * std::sin(0.9 * x * y / 64);
      *image.at(x, y) = static_cast<std::uint8_t>(std::lround(value));
    }
  }
  return image;
}

template <typename Real>
Real sample(const hal::Image& image, Real x, Real y) {
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const Real a = x - static_cast<Real>(x0);
  const Real b = y - static_cast<Real>(y0);
  const auto at = [&](int u, int v) { return static_cast<Real>(*image.at(u, v)); };
  return (1 - b) * ((1 - a) * at(x0, y0) + a * at(x0 + 1, y0)) +
         b * ((1 - a) * at(x0, y0 + 1) + a * at(x0 + 1, y0 + 1));
}

/// align_patch with another type of number: the same steps and the same stop, from 1 px or nearer.
template <typename Real>
Eigen::Matrix<Real, 2, 1> align(const hal::Image& image, const PatchTemplate& patch,
                                const Eigen::Vector2d& start) {
  using Vector4 = Eigen::Matrix<Real, 4, 1>;
  constexpr int kSide = PatchTemplate::kSide;
  const Real mean = static_cast<Real>(patch.sum) / (kPatch * kPatch);
  const auto value = [&](int u, int v) {
    return static_cast<Real>(patch.values[static_cast<std::size_t>((v + 1) * kSide + u + 1)]);
  };
  const auto slope = [&](int u, int v) {
    return Vector4((value(u + 1, v) - value(u - 1, v)) / 2, (value(u, v + 1) - value(u, v - 1)) / 2,
                   Real(1), (value(u, v) - mean) / 50);
  };
  Eigen::Matrix<Real, 4, 4> hessian = Eigen::Matrix<Real, 4, 4>::Zero();
  for (int i = 0; i < kPatch * kPatch; ++i) {
    hessian += slope(i % kPatch, i / kPatch) * slope(i % kPatch, i / kPatch).transpose();
  }
  Vector4 state(static_cast<Real>(start.x()), static_cast<Real>(start.y()), 0, 0);
  for (int iteration = 0; iteration < 10; ++iteration) {
    Vector4 gradient = Vector4::Zero();
    for (int i = 0; i < kPatch * kPatch; ++i) {
      const int u = i % kPatch;
      const int v = i / kPatch;
      const Real seen = sample<Real>(image, state[0] + u - Real(3.5), state[1] + v - Real(3.5));
      const Real wanted = value(u, v) + state[2] + state[3] * (value(u, v) - mean) / 50;
      gradient += slope(u, v) * (seen - wanted);
    }
    const Vector4 step = hessian.inverse() * gradient;
    const Real contrast = 1 + (state[3] + step[3]) / 50;
    state += Vector4(-step[0] / contrast, -step[1] / contrast, step[2], step[3]);
    if (step.template head<2>().norm() < Real(0.01)) break;
  }
  return state.template head<2>();
}

// Alignment is good to 0.02 px at best, so 1e-3 px of float decides nothing; and double is as good
// as long double, to 1e-9 px.
TEST_F(PatchNumerics, AlignmentInFloatAgreesWithDoubleAndLongDouble) {
  const hal::Image image = textured(160, 120);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int aligned = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d center(80.0 + 60.0 * unit(random), 60.0 + 45.0 * unit(random));
    const Eigen::Matrix2d warp =
        Eigen::Matrix2d::Identity() +
        0.1 * Eigen::Matrix2d{{unit(random), unit(random)}, {unit(random), unit(random)}};
    const auto patch = make_template(image, center, warp);
    if (!patch) continue;
    const Eigen::Vector2d start = center + 0.5 * Eigen::Vector2d(unit(random), unit(random));
    const auto found = align_patch(image, *patch, start);
    if (!found) continue;
    ++aligned;
    const Eigen::Vector2d in_double = align<double>(image, *patch, start);
    EXPECT_LT((*found - in_double).norm(), 1e-3) << center.transpose();
    EXPECT_LT((in_double - align<long double>(image, *patch, start).cast<double>()).norm(), 1e-9);
  }
  EXPECT_GT(aligned, 100);
}

// On a slope that is the same everywhere no place is better than another: the normal equations are
// singular, but for rounding. Such a patch has no position, in no number format.
TEST_F(PatchNumerics, APlainSlopeHasNoPosition) {
  hal::Image image(64, 48, 1);
  for (int right = 1; right <= 3; ++right) {
    for (int down = 0; down <= 2; ++down) {
      for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; ++x) {
          *image.at(x, y) = static_cast<std::uint8_t>(right * x + down * y / 2);
        }
      }
      for (const double angle : {0.0, 0.3, 0.7}) {
        Eigen::Matrix2d warp;
        warp << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
        const auto patch = make_template(image, {30.3, 20.7}, 1.37 * warp);
        if (!patch || (down % 2) != 0) continue;  // halves are rounded: no plain slope
        EXPECT_FALSE(align_patch(image, *patch, {30.8, 20.2})) << right << ' ' << down;
      }
    }
  }
}

// Scores are integers up to the last division. Against long double: rounding only, and the same
// place wins.
TEST_F(PatchNumerics, CorrelationAgreesWithLongDouble) {
  const hal::Image image = textured(160, 120);
  const auto patch = make_template(image, {71.5, 52.5}, Eigen::Matrix2d::Identity());
  ASSERT_TRUE(patch);
  long double best = -2.0L;
  Eigen::Vector2d best_place = Eigen::Vector2d::Zero();
  for (int y = 40; y < 65; ++y) {
    for (int x = 60; x < 85; ++x) {
      long double a = 0.0L, b = 0.0L, aa = 0.0L, bb = 0.0L, ab = 0.0L;
      for (int i = 0; i < kPatch * kPatch; ++i) {
        const long double p = patch->core[static_cast<std::size_t>(i)];
        const long double q = *image.at(x + i % kPatch, y + i / kPatch);
        a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
      }
      const long double exact =
          (64 * ab - a * b) / std::sqrt((64 * aa - a * a) * (64 * bb - b * b));
      const auto found = correlation_at(image, *patch, {x + 3.5, y + 3.5});
      ASSERT_TRUE(found);
      EXPECT_NEAR(*found, static_cast<double>(exact), 4e-16);
      EXPECT_LE(std::abs(*found), 1.0 + 4e-16);
      if (exact > best) {
        best = exact;
        best_place = Eigen::Vector2d(x + 3.5, y + 3.5);
      }
    }
  }
  const auto match = search_square(image, *patch, {72.0, 52.0}, 9.0);
  ASSERT_TRUE(match);
  EXPECT_EQ(match->pixel, best_place);
}

// A patch that ends a hair before the last pixel ends on it in float: the pixel beside it must not
// be read (the address sanitizer sees it), and the value is that of the last pixel.
TEST_F(PatchNumerics, TemplatesMayEndARoundingBeforeTheBorder) {
  const hal::Image image = textured(640, 480);
  for (const double hair : {1e-12, 1e-9, 1e-6, 1e-5}) {
    const auto patch =
        make_template(image, {639.0 - 4.5 - hair, 479.0 - 4.5 - hair}, Eigen::Matrix2d::Identity());
    ASSERT_TRUE(patch) << hair;
    EXPECT_NEAR(static_cast<double>(patch->values.back()), *image.at(639, 479), 0.01) << hair;
  }
}

// Grey values in float: half a rounding of the coordinate (3e-5 px at 640) times a slope of up to
// 60 levels a pixel.
TEST_F(PatchNumerics, SamplesInFloatAgreeWithDouble) {
  const hal::Image image = textured(640, 480);
  const Eigen::Matrix2d warp{{1.1, 0.2}, {-0.3, 0.9}};
  const Eigen::Vector2d center(612.3, 455.7);
  const auto patch = make_template(image, center, warp);
  ASSERT_TRUE(patch);
  for (int i = 0; i < PatchTemplate::kSide * PatchTemplate::kSide; ++i) {
    const Eigen::Vector2d offset(i % PatchTemplate::kSide - 4.5, i / PatchTemplate::kSide - 4.5);
    const Eigen::Vector2d at = center + warp * offset;
    EXPECT_NEAR(static_cast<double>(patch->values[static_cast<std::size_t>(i)]),
                sample<double>(image, at.x(), at.y()), 0.01);
  }
}

}  // namespace
}  // namespace lumibox::tracking
