#include "bench/sweep_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lumibox::bench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Knee, IsTheCheapestThatIsNearlyAsGoodAsTheBest) {
  SweepCurve curve{"max_measurements", "walk", {}};
  curve.points = {{100, false, 1.0, 5.0}, {200, false, 2.0, 1.05}, {400, true, 4.0, 1.0}};
  EXPECT_EQ(knee(curve), 1U);
  curve.points[1].error = 1.2;
  EXPECT_EQ(knee(curve), 2U);
}

TEST(Knee, IsNotAmongThoseThatLostFrames) {
  SweepCurve curve{"max_measurements", "walk", {}};
  // The first is accurate over the few frames that it has.
  curve.points = {{100, false, 1.0, 0.1, 0.3}, {200, true, 2.0, 1.0}};
  EXPECT_EQ(knee(curve), 1U);
}

TEST(Knee, NeedsErrors) {
  EXPECT_FALSE(knee({"max_measurements", "walk", {}}));
  EXPECT_FALSE(knee({"max_measurements", "walk", {{100, true, 1.0, std::nullopt}}}));
}

TEST(SweepPlot, HasADiagramPerSettingAndALinePerFootage) {
  const std::vector<SweepPoint> points{{100, false, 1.0, 5.0, 0.5}, {400, true, 4.0, 1.0}};
  const std::string text = draw_sweep("costs", {{"max_measurements", "walk", points},
                                                {"max_measurements", "desk", points},
                                                {"image_width", "walk", points, "my ms", "my %"}})
                               .str();
  EXPECT_THAT(text, AllOf(HasSubstr(">costs<"), HasSubstr(">max_measurements<"),
                          HasSubstr(">image_width<"), HasSubstr(">walk<"), HasSubstr(">desk<")));
  EXPECT_THAT(text, AllOf(HasSubstr(">my ms<"), HasSubstr(">my %<"), HasSubstr(">default<"),
                          HasSubstr(">100 (50 %)<"), HasSubstr(">400<")));
}

TEST(SweepPlot, DiagramsShareTheirAxesWithThoseOfTheSameCostOnly) {
  const auto points = [](double ms) {
    return std::vector<SweepPoint>{{111, false, ms, 5.0}, {222, true, 4.0 * ms, 5.0}};
  };
  const std::string text = draw_sweep("costs", {{"a", "walk", points(1.0), "tracker", "error"},
                                                {"b", "walk", points(100.0), "mapper", "error"}})
                               .str();
  EXPECT_THAT(text, AllOf(HasSubstr(">2<"), HasSubstr(">200<"))) << "ticks of either";
}

TEST(SweepPlot, PointsThatLieTogetherShareALabel) {
  const std::string text =
      draw_sweep("costs", {{"pyramid_levels",
                            "walk",
                            {{2, false, 4.0, 1.0}, {3, false, 4.01, 1.0}, {4, true, 8.0, 9.0}}}})
          .str();
  EXPECT_THAT(text, AllOf(HasSubstr(">2, 3<"), HasSubstr(">4<")));
}

TEST(SweepPlot, WithoutATruthIsStillAPage) {
  const std::string text =
      draw_sweep("costs", {{"image_width", "walk", {{640, true, 4.0, std::nullopt}}}}).str();
  EXPECT_THAT(text, AllOf(HasSubstr(">image_width<"), Not(HasSubstr("nan"))));
}

}  // namespace
}  // namespace lumibox::bench
