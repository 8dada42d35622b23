#include "tracking/pyramid.h"

#include <gtest/gtest.h>

namespace lumibox::tracking {
namespace {

TEST(Pyramid, HalvesByMeansOfFour) {
  hal::Image image(4, 2, 1);
  for (int x = 0; x < 4; ++x) {
    *image.at(x, 0) = static_cast<std::uint8_t>(10 * x);
    *image.at(x, 1) = static_cast<std::uint8_t>(10 * x + 4);
  }
  const Pyramid pyramid(image, 2);
  ASSERT_EQ(pyramid.levels(), 2);
  EXPECT_EQ(pyramid.level(1).width(), 2);
  EXPECT_EQ(pyramid.level(1).height(), 1);
  EXPECT_EQ(*pyramid.level(1).at(0, 0), 7);   // (0 + 10 + 4 + 14) / 4
  EXPECT_EQ(*pyramid.level(1).at(1, 0), 27);  // (20 + 30 + 24 + 34) / 4
}

TEST(Pyramid, EndsWhereNoPixelIsLeft) {
  EXPECT_EQ(Pyramid(hal::Image(9, 4, 1), 8).levels(), 3);  // 9x4, 4x2, 2x1
}

TEST(Pyramid, LevelPositionsAreInverse) {
  for (int level = 0; level < 5; ++level) {
    const Eigen::Vector2d pixel(123.25, 45.5);
    EXPECT_LT((from_level(to_level(pixel, level), level) - pixel).norm(), 1e-12);
  }
  EXPECT_EQ(from_level(Eigen::Vector2d(0.0, 0.0), 1), Eigen::Vector2d(0.5, 0.5));
}

}  // namespace
}  // namespace lumibox::tracking
