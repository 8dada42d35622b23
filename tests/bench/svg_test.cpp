#include "bench/svg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/input_error.h"

namespace lumibox::bench {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Svg, IsOnePageOfTheSizeAskedFor) {
  const std::string text = Svg(300, 200).str();
  EXPECT_THAT(text, AllOf(StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\""),
                          HasSubstr("width=\"300\" height=\"200\""), EndsWith("</svg>\n")));
}

TEST(Svg, ShapesAreWhereTheyWerePut) {
  Svg svg(100, 100);
  svg.line({1, 2}, {3, 4.5}, {.stroke = "red", .width = 2, .dashes = "4 3"});
  svg.circle({10, 20}, 5, {.fill = "blue", .opacity = 0.5});
  svg.rect({1, 2}, {30, 40}, {.stroke = "#123"});
  const std::string text = svg.str();
  EXPECT_THAT(text, HasSubstr("d=\"M1.00 2.00L3.00 4.50\""));
  EXPECT_THAT(text, HasSubstr("stroke=\"red\" stroke-width=\"2\" stroke-dasharray=\"4 3\""));
  EXPECT_THAT(text, HasSubstr("<circle cx=\"10.00\" cy=\"20.00\" r=\"5.00\" fill=\"blue\""));
  EXPECT_THAT(text, HasSubstr("opacity=\"0.5\""));
  EXPECT_THAT(text, HasSubstr("<rect x=\"1.00\" y=\"2.00\" width=\"30.00\" height=\"40.00\""));
}

TEST(Svg, TextCannotBreakTheFile) {
  Svg svg(100, 100);
  svg.text({1, 2}, "a<b & c>d\n", {.anchor = Anchor::End, .upwards = true});
  EXPECT_THAT(svg.str(), AllOf(HasSubstr(">a&lt;b &amp; c&gt;d?</text>"),
                               HasSubstr("text-anchor=\"end\""), HasSubstr("rotate(-90 ")));
}

TEST(Svg, LinesBreakWhereThereIsNoNumber) {
  Svg svg(100, 100);
  const std::vector<Vector2d> points{{1, 1}, {2, 2}, {kNaN, 3}, {4, 4}, {5, 5}};
  svg.polyline(points, {.stroke = "red"});
  EXPECT_THAT(svg.str(), HasSubstr("M1.00 1.00L2.00 2.00M4.00 4.00L5.00 5.00"));
}

TEST(Svg, WhatHasNoPlaceIsLeftOut) {
  const std::string nothing = Svg(100, 100).str();
  Svg svg(100, 100);
  const std::vector<Vector2d> nowhere{{kNaN, 1}, {1, std::numeric_limits<double>::infinity()}};
  svg.polyline(nowhere, {});
  svg.dots(nowhere, 1, {});
  svg.line({0, 0}, nowhere[0], {});
  svg.circle({0, 0}, kNaN, {});
  svg.rect(nowhere[1], {1, 1}, {});
  svg.text(nowhere[0], "x");
  EXPECT_EQ(svg.str(), nothing);
}

TEST(Svg, EachClipIsClosedAndItsOwn) {
  Svg svg(100, 100);
  svg.clip({0, 0}, {10, 10});
  svg.unclip();
  svg.clip({20, 0}, {10, 10});
  svg.unclip();
  EXPECT_THAT(svg.str(), AllOf(HasSubstr("clipPath id=\"clip0\""), HasSubstr("url(#clip1)"),
                               HasSubstr("</g>"), Not(HasSubstr("clip2"))));
}

TEST(Svg, FileThatCannotBeWrittenIsNamed) {
  EXPECT_THAT(testing::message_of([] { write_svg("/dev/full", Svg(10, 10)); }),
              HasSubstr("/dev/full"));
}

}  // namespace
}  // namespace lumibox::bench
