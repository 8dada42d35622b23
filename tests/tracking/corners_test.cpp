#include "tracking/corners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tracking/textured_world.h"

namespace lumibox::tracking {
namespace {

TEST(Corners, FindsACornerOfASquareAndNotItsEdges) {
  hal::Image image(64, 64, 1);
  for (int y = 24; y < 64; ++y) {
    for (int x = 24; x < 64; ++x) *image.at(x, y) = static_cast<std::uint8_t>(260 - x - y);
  }
  const auto corners = detect_corners(Pyramid(image, 1), 10, 100);
  ASSERT_EQ(corners.size(), 1U);
  EXPECT_LT((corners[0].pixel - Eigen::Vector2d(24, 24)).norm(), 2.0);
}

TEST(Corners, CoverThePictureAndKeepTheLimit) {
  const auto camera = testing::small_camera();
  const Pyramid pyramid(testing::render_wedge(camera, geometry::Pose()), 4);
  const auto all = detect_corners(pyramid, 10, 5000);
  EXPECT_GT(all.size(), 150U);
  const auto few = detect_corners(pyramid, 10, 50);
  ASSERT_EQ(few.size(), 50U);
  for (std::size_t i = 1; i < few.size(); ++i) EXPECT_GE(few[i - 1].score, few[i].score);
}

TEST(Corners, WeakOnesAreTakenWhereThereAreNoStrongOnes) {
  // A floor whose grain is some ten grey levels from dark to bright, and a label in the middle of
  // it.
  hal::Image image(320, 240, 1);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const bool label = std::abs(x - 160) < 40 && std::abs(y - 120) < 40;
      const double value = testing::noise(x / 100.0, y / 100.0) - 128.0;
      *image.at(x, y) =
          static_cast<std::uint8_t>(std::lround(128.0 + (label ? 1.0 : 0.12) * value));
    }
  }
  const auto on_floor = [](const std::vector<Corner>& corners) {
    return std::count_if(corners.begin(), corners.end(), [](const Corner& c) {
      return std::abs(c.pixel.x() - 160.0) > 50.0 || std::abs(c.pixel.y() - 120.0) > 50.0;
    });
  };
  const Pyramid pyramid(image, 1);
  EXPECT_GT(on_floor(detect_corners(pyramid, 10, 200)), 30);
  EXPECT_EQ(on_floor(detect_corners(pyramid, 10, 20)), 0) << "the label alone has enough";
}

TEST(Corners, NoneInAFlatPicture) {
  EXPECT_TRUE(detect_corners(Pyramid(hal::Image(64, 64, 1), 3), 10, 100).empty());
}

}  // namespace
}  // namespace lumibox::tracking
