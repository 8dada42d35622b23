#include "geometry/robust.h"

#include <gtest/gtest.h>

namespace lumibox::geometry {
namespace {

TEST(Robust, TukeyFallsFromOneToZeroAtTheLimit) {
  EXPECT_EQ(tukey_weight(0.0, 2.0), 1.0);
  EXPECT_EQ(tukey_weight(1.0, 2.0), 0.5625);
  EXPECT_EQ(tukey_weight(-1.0, 2.0), 0.5625);
  EXPECT_EQ(tukey_weight(2.0, 2.0), 0.0);
  EXPECT_EQ(tukey_weight(0.0, 0.0), 0.0);
}

TEST(Robust, HuberKeepsTheInfluenceConstantBeyondTheLimit) {
  EXPECT_EQ(huber_weight(0.0, 0.0), 1.0);
  EXPECT_EQ(huber_weight(1.5, 2.0), 1.0);
  EXPECT_EQ(huber_weight(-8.0, 2.0), 0.25);
}

TEST(Robust, MedianOfOddAndEvenCounts) {
  EXPECT_EQ(median({}), 0.0);
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 2.5);
}

TEST(Robust, QuantileIsAValueThatIsThere) {
  EXPECT_EQ(quantile({}, 0.5), 0.0);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.0), 1.0);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.51), 3.0);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 1.0), 4.0);
}

TEST(Robust, SigmaIgnoresOutliers) {
  const std::vector<double> residuals{-1.0, 1.0, -1.0, 1.0, 1000.0};
  EXPECT_DOUBLE_EQ(mad_sigma(residuals), 1.4826);
}

}  // namespace
}  // namespace lumibox::geometry
