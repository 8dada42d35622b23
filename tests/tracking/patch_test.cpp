#include "tracking/patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "tracking/textured_world.h"

namespace lumibox::tracking {
namespace {

hal::Image noise_image(double shift_x, double shift_y, double gain, double offset) {
  hal::Image image(80, 60, 1);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const double value = testing::noise((x - shift_x) / 80.0, (y - shift_y) / 80.0);
      *image.at(x, y) = static_cast<std::uint8_t>(std::lround(gain * value + offset));
    }
  }
  return image;
}

PatchTemplate template_at(const hal::Image& image, const Eigen::Vector2d& center) {
  const auto patch = make_template(image, center, Eigen::Matrix2d::Identity());
  EXPECT_TRUE(patch.has_value());
  return *patch;
}

TEST(Patch, FoundWhereItCameFrom) {
  const hal::Image image = noise_image(0.0, 0.0, 1.0, 0.0);
  const Eigen::Vector2d center(40.5, 30.5);
  const auto match = search_square(image, template_at(image, center), Eigen::Vector2d(44, 27), 6.0);
  ASSERT_TRUE(match.has_value());
  EXPECT_EQ(match->pixel, center);
  EXPECT_NEAR(match->correlation, 1.0, 1e-9);
}

// 0.05 px: bilinear interpolation smooths waves of four pixels, which pulls to whole pixels.
TEST(Patch, AlignmentIsSubPixelUnderGainAndOffset) {
  const hal::Image first = noise_image(0.0, 0.0, 1.0, 0.0);
  for (const double shift : {0.0, 0.25, 0.5, 0.8}) {
    const hal::Image second = noise_image(shift, -shift, 0.6, 30.0);
    const Eigen::Vector2d center(40.5, 30.5);
    const auto aligned = align_patch(second, template_at(first, center), center);
    ASSERT_TRUE(aligned.has_value()) << shift;
    EXPECT_LT((*aligned - center - Eigen::Vector2d(shift, -shift)).norm(), 0.05) << shift;
  }
}

// An exposure that recovers from the dark triples the contrast within a second. 0.1 px: the darker
// picture is rounded to whole grey levels.
TEST(Patch, AlignmentConvergesWhenTheContrastHasTripled) {
  const hal::Image dark = noise_image(0.0, 0.0, 0.3, 5.0);
  const hal::Image bright = noise_image(0.7, -0.6, 0.9, 20.0);
  const Eigen::Vector2d center(40.5, 30.5);
  for (const auto& [first, second, shift] :
       {std::tuple{dark, bright, 1.0}, std::tuple{bright, dark, -1.0}}) {
    const auto aligned = align_patch(second, template_at(first, center), center);
    ASSERT_TRUE(aligned.has_value());
    EXPECT_LT((*aligned - center - shift * Eigen::Vector2d(0.7, -0.6)).norm(), 0.1);
  }
}

TEST(Patch, CorrelationIgnoresExposure) {
  const hal::Image first = noise_image(0.0, 0.0, 1.0, 0.0);
  const hal::Image second = noise_image(0.0, 0.0, 0.5, 80.0);
  const Eigen::Vector2d center(20.5, 20.5);
  EXPECT_GT(correlation_at(second, template_at(first, center), center).value(), 0.995);
}

TEST(Patch, FlatOrTruncatedPatchesAreRefused) {
  const hal::Image flat(40, 40, 1);
  EXPECT_FALSE(make_template(flat, Eigen::Vector2d(20, 20), Eigen::Matrix2d::Identity()));
  const hal::Image image = noise_image(0.0, 0.0, 1.0, 0.0);
  EXPECT_FALSE(make_template(image, Eigen::Vector2d(2, 20), Eigen::Matrix2d::Identity()));
  EXPECT_FALSE(make_template(image, Eigen::Vector2d(20, 59), Eigen::Matrix2d::Identity()));
  const PatchTemplate patch = template_at(image, Eigen::Vector2d(20, 20));
  EXPECT_FALSE(search_square(image, patch, Eigen::Vector2d(-50, 20), 3.0));
  EXPECT_FALSE(correlation_at(image, patch, Eigen::Vector2d(1, 1)));
  EXPECT_FALSE(align_patch(flat, patch, Eigen::Vector2d(2, 2)));
}

}  // namespace
}  // namespace lumibox::tracking
