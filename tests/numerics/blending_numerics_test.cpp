#include <cmath>
#include <numeric>

#include "numerics/trap.h"
#include "render/blending.h"

namespace lumibox::render {
namespace {

using BlendingNumerics = Trapped;

double total(const std::vector<double>& weights) {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

// Near the limit a high exponent underflows: (1e-6)^64 is below every double. The ratio of two
// weights is what counts, and it must survive: 1e-9, for 64 times the rounding of 1 - p, 1e-10
// here.
TEST_F(BlendingNumerics, HighExponentsKeepTheRatioOfWeights) {
  for (const double exponent : {0.0, 1.0, 2.0, 16.0, 64.0}) {
    const auto weights = wide_weights({1.0 - 3e-6, 1.0 - 2e-6, 1.0 - 1e-6}, 1.0, exponent);
    EXPECT_NEAR(total(weights), 1.0, 1e-15);
    EXPECT_NEAR(weights[1] / weights[0], std::pow(2.0 / 3.0, exponent), 1e-8) << exponent;
    EXPECT_GE(weights[0], weights[1]);
    EXPECT_GE(weights[1], weights[2]);
  }
}

// 420 perspectives at one point, at S, or at the limit: all alike, and no 0 / 0.
TEST_F(BlendingNumerics, EqualPenaltiesGiveEqualWeights) {
  for (const double penalty : {0.0, 1e-300, 1e-16, 0.5, 3.14}) {
    const std::vector<double> penalties(420, penalty);
    for (const double limit : {penalty, limit_beyond(penalties)}) {
      for (const double exponent : {0.0, 2.0, 64.0}) {
        for (const double weight : wide_weights(penalties, limit, exponent)) {
          ASSERT_NEAR(weight, 1.0 / 420.0, 1e-16);
        }
      }
    }
  }
  EXPECT_TRUE(wide_weights({}, limit_beyond({}), 2.0).empty());
}

// The shader blends in float. Of 8 bits half a step is 2e-3; the sums of 128 layers in float are
// good to 128 roundings of 6e-8, and must be, for equal weights add up to 1 that way.
TEST_F(BlendingNumerics, FloatSumsOfTheShaderAgreeWithDouble) {
  for (const std::size_t k : {1U, 2U, 3U, 40U, 128U}) {
    std::vector<double> penalties;
    for (std::size_t i = 0; i < k; ++i)
      penalties.push_back(0.01 * std::sqrt(static_cast<double>(i + 1)));
    const auto weights = wide_weights(penalties, limit_beyond(penalties), 2.0);
    float sum = 0.0F;
    float color = 0.0F;
    double exact = 0.0;
    float front = 0.0F;
    float transmittance = 1.0F;
    double over = 0.0;
    for (std::size_t i = 0; i < k; ++i) {
      const double value = 0.5 + 0.5 * std::sin(static_cast<double>(i));
      sum += static_cast<float>(weights[i]);
      color += static_cast<float>(weights[i]) * static_cast<float>(value);
      exact += weights[i] * value;
      const double alpha = i == 0 ? 0.7 : small_alpha(i, k, 0.4);  // the nearest one's border
      front += transmittance * static_cast<float>(alpha) * static_cast<float>(value);
      transmittance *= 1.0F - static_cast<float>(alpha);
    }
    for (std::size_t i = k; i-- > 0;) {  // the reference goes from far to near
      const double alpha = i == 0 ? 0.7 : small_alpha(i, k, 0.4);
      over = alpha * (0.5 + 0.5 * std::sin(static_cast<double>(i))) + (1.0 - alpha) * over;
    }
    EXPECT_NEAR(static_cast<double>(color / sum), exact, 128 * 6e-8) << k;
    EXPECT_NEAR(static_cast<double>(front), over, 128 * 6e-8) << k;
  }
}

// The border's factor in float, as in the shader, against double: 1e-5 is a hundredth of a grey
// level. The pixel itself has 3e-5 px in float at 640, times a slope of at most 1.5 / 48 px.
TEST_F(BlendingNumerics, FeatherInFloatAgreesWithDouble) {
  const auto width = static_cast<float>(1.0 / feather_width(640, 480, 48.0));
  const auto fade = [&](float t) {
    const float c = std::min(std::max(t * width, 0.0F), 1.0F);
    return c * c * (3.0F - 2.0F * c);
  };
  for (double x = -3.0; x < 645.0; x += 0.37) {
    const auto u = static_cast<float>(x);
    const float across = fade(std::min(u, 639.0F - u));
    EXPECT_NEAR(static_cast<double>(across), feather({x, 240.0}, 640, 480, 48.0), 1e-5) << x;
  }
}

}  // namespace
}  // namespace lumibox::render
