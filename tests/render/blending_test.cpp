#include "render/blending.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lumibox::render {
namespace {

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Increasing penalties in [0, pi] from integers, with many ties and zeros.
std::vector<double> penalties_from(std::vector<int> steps) {
  std::vector<double> penalties;
  for (const int step : steps) penalties.push_back(std::abs(step % 50) * (M_PI / 50.0));
  std::sort(penalties.begin(), penalties.end());
  return penalties;
}

RC_GTEST_PROP(WideWeights, SumToOneAndDoNotIncrease, (const std::vector<int>& steps)) {
  const std::vector<double> penalties = penalties_from(steps);
  RC_PRE(!penalties.empty());
  const double limit = *rc::gen::element(limit_beyond(penalties), penalties.back(), M_PI);
  const double exponent = *rc::gen::element(0.0, 0.5, 1.0, 2.0, 8.0, 300.0, -1.0);
  const std::vector<double> weights = wide_weights(penalties, limit, exponent);
  RC_ASSERT(std::abs(sum_of(weights) - 1.0) < 1e-9);
  RC_ASSERT(std::is_sorted(weights.rbegin(), weights.rend()));
}

TEST(WideWeights, FallToZeroAtTheFirstLeftOut) {
  const std::vector<double> weights = wide_weights({0.1, 0.2, 0.4}, 0.4, 2.0);
  EXPECT_GT(weights[1], 0.0);
  EXPECT_EQ(weights[2], 0.0);
  EXPECT_NEAR(weights[0] / weights[1], std::pow(0.75 / 0.5, 2.0), 1e-12);
}

TEST(WideWeights, ExponentZeroMakesAllEqual) {
  for (const double weight : wide_weights({0.0, 0.3, 0.5}, 0.5, 0.0)) {
    EXPECT_DOUBLE_EQ(weight, 1.0 / 3.0);
  }
}

TEST(WideWeights, AllAsFarAsTheLimitAreEqual) {
  for (const double limit : {0.0, 0.2}) {
    for (const double weight : wide_weights({limit, limit}, limit, 3.0)) {
      EXPECT_DOUBLE_EQ(weight, 0.5);
    }
  }
}

TEST(WideWeights, NothingLeftOutStillWeighsTheFarthest) {
  const std::vector<double> penalties = {0.1, 0.2, 0.3, 0.4};
  EXPECT_GT(wide_weights(penalties, limit_beyond(penalties), 2.0).back(), 0.0);
  EXPECT_TRUE(wide_weights({}, limit_beyond({}), 2.0).empty());
}

// Thesis 3.2, far to near: 0 to 0.4 over the first half, 0.4, and 1 for the nearest.
TEST(SmallAlpha, IsTheRampOfTheThesis) {
  EXPECT_DOUBLE_EQ(small_alpha(39, 40, 0.4), 0.0);
  EXPECT_DOUBLE_EQ(small_alpha(29, 40, 0.4), 0.2);
  EXPECT_DOUBLE_EQ(small_alpha(19, 40, 0.4), 0.4);
  EXPECT_DOUBLE_EQ(small_alpha(1, 40, 0.4), 0.4);
  EXPECT_DOUBLE_EQ(small_alpha(0, 40, 0.4), 1.0);
}

TEST(SmallAlpha, IsFiniteForEveryK) {
  for (std::size_t k = 0; k < 10; ++k) {
    for (std::size_t rank = 0; rank < 10; ++rank) {
      const double alpha = small_alpha(rank, k, 0.4);
      EXPECT_TRUE(alpha >= 0.0 && alpha <= 1.0) << rank << " of " << k;
    }
  }
}

TEST(Feather, IsZeroOnTheBorderAndOneInside) {
  EXPECT_EQ(feather({0.0, 240.0}, 640, 480, 48.0), 0.0);
  EXPECT_EQ(feather({320.0, 479.0}, 640, 480, 48.0), 0.0);
  EXPECT_EQ(feather({-3.0, 700.0}, 640, 480, 48.0), 0.0);
  EXPECT_DOUBLE_EQ(feather({24.0, 240.0}, 640, 480, 48.0), 0.5);
  EXPECT_DOUBLE_EQ(feather({48.0, 48.0}, 640, 480, 48.0), 1.0);
}

TEST(Feather, LeavesTheMiddleOfASmallPictureOpaque) {
  EXPECT_DOUBLE_EQ(feather({16.0, 12.0}, 33, 25, 48.0), 1.0);
  EXPECT_DOUBLE_EQ(feather({10.0, 10.0}, 640, 480, 0.0), 1.0);
}

}  // namespace
}  // namespace lumibox::render
