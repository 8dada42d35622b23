#include "bench/axes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace lumibox::bench {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Axes, LowerLeftIsTheLeastAndUpperRightTheMost) {
  const Axes axes({100, 50}, {200, 80}, {"t [s]", {2, 6}},
                  {"error [m]", {0.01, 1}, Scale::Logarithmic});
  EXPECT_TRUE(axes.at(2, 0.01).isApprox(Vector2d(100, 130)));
  EXPECT_TRUE(axes.at(6, 1).isApprox(Vector2d(300, 50)));
  EXPECT_TRUE(axes.at(3, 0.1).isApprox(Vector2d(150, 90)));
}

TEST(Axes, LabelsAreOnThePage) {
  Svg svg(400, 200);
  Axes({100, 50}, {200, 80}, {"t [s]", {2, 6}}, {"", {0, 1}}).draw(svg, "the title");
  EXPECT_THAT(svg.str(), HasSubstr(">t [s]</text>"));
  EXPECT_THAT(svg.str(), HasSubstr(">the title</text>"));
  EXPECT_THAT(svg.str(), HasSubstr(">4</text>"));
}

TEST(Ticks, AreRoundAndWithin) {
  EXPECT_THAT(ticks({"", {-0.11, 0.31}}, 4), ElementsAre(DoubleEq(0.0), DoubleEq(0.2)));
  EXPECT_THAT(ticks({"", {3, 11}}, 4), ElementsAre(4, 6, 8, 10));
  EXPECT_THAT(ticks({"", {0.5, 12}, Scale::Logarithmic}, 4),
              ElementsAre(DoubleEq(0.5), DoubleEq(1), DoubleEq(2), DoubleEq(5), DoubleEq(10)));
  EXPECT_THAT(ticks({"", {0.5, 1200}, Scale::Logarithmic}, 4),
              ElementsAre(DoubleEq(1), DoubleEq(10), DoubleEq(100), DoubleEq(1000)));
}

TEST(Ticks, AreLabelledWithoutNoise) {
  EXPECT_EQ(tick_label(0.1 + 0.2), "0.3");
  EXPECT_EQ(tick_label(1e-17), "0");
  EXPECT_EQ(tick_label(1500), "1500");
}

TEST(Range, HoldsWhatItWasToldAndIsNeverWithoutLength) {
  Range range;
  EXPECT_TRUE(range.empty());
  EXPECT_LT(range.padded(0.1).low, range.padded(0.1).high);
  range.include(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(range.empty());
  range.include(3);
  EXPECT_LT(range.padded(0.1).low, range.padded(0.1).high);
  range.include(5);
  EXPECT_DOUBLE_EQ(range.padded(0.1).low, 2.8);
  EXPECT_DOUBLE_EQ(range.padded(0.1).high, 5.2);
}

}  // namespace
}  // namespace lumibox::bench
