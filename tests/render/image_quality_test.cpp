#include "render/image_quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "render/ray_cast.h"

namespace lumibox::render {
namespace {

hal::Image uniform(int width, int height, std::uint8_t value) {
  hal::Image image(width, height, 3);
  std::fill_n(image.data(), image.size_bytes(), value);
  return image;
}

hal::Image uniform_mask(int width, int height) {
  hal::Image mask(width, height, 1);
  std::fill_n(mask.data(), mask.size_bytes(), std::uint8_t{255});
  return mask;
}

TEST(Psnr, OfAKnownError) {
  const hal::Image a = uniform(20, 10, 100);
  EXPECT_NEAR(psnr(a, uniform(20, 10, 105)), 20.0 * std::log10(255.0 / 5.0), 1e-9);
  EXPECT_EQ(psnr(a, a), kMaxPsnr);
}

TEST(Psnr, CountsOnlyTheMask) {
  const hal::Image a = uniform(20, 10, 100);
  hal::Image b = a;
  b.at(3, 4)[1] = 0;
  hal::Image mask(20, 10, 1);
  *mask.at(0, 0) = 255;
  EXPECT_EQ(psnr(a, b, &mask), kMaxPsnr);
  *mask.at(3, 4) = 1;
  EXPECT_NEAR(psnr(a, b, &mask), 10.0 * std::log10(255.0 * 255.0 * 6.0 / 1e4), 1e-9);
}

TEST(Psnr, NothingToCompareIsNoNumber) {
  const hal::Image a = uniform(20, 10, 100);
  const hal::Image no_pixel(20, 10, 1);
  EXPECT_TRUE(std::isnan(psnr(a, a, &no_pixel)));
  EXPECT_TRUE(std::isnan(psnr(a, uniform(10, 20, 100))));
  EXPECT_TRUE(std::isnan(ssim(a, a)));  // smaller than the window
  EXPECT_TRUE(std::isnan(ssim(hal::Image(), hal::Image())));
}

// Flat pictures have no structure: only the luminance term is left.
TEST(Ssim, OfFlatPicturesIsTheLuminanceTerm) {
  const double c1 = 0.01 * 255.0 * 0.01 * 255.0;
  const double expected = (2.0 * 100.0 * 150.0 + c1) / (100.0 * 100.0 + 150.0 * 150.0 + c1);
  EXPECT_NEAR(ssim(uniform(40, 30, 100), uniform(40, 30, 150)), expected, 1e-9);
}

TEST(Ssim, IsOneForEqualAndNegativeForInvertedPictures) {
  hal::Image a(40, 30, 3);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      for (int c = 0; c < 3; ++c) a.at(x, y)[c] = (x / 3 + y / 3) % 2 == 0 ? 40 : 215;
    }
  }
  hal::Image inverted = a;
  for (std::size_t i = 0; i < a.size_bytes(); ++i) {
    inverted.data()[i] = static_cast<std::uint8_t>(255 - a.data()[i]);
  }
  EXPECT_NEAR(ssim(a, a), 1.0, 1e-12);
  EXPECT_LT(ssim(a, inverted), -0.9);
}

/// Smooth stripes that move with (dx, dy).
hal::Image waves(double dx, double dy) {
  hal::Image image(60, 40, 3);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) {
      const double value =
          128.0 + 60.0 * std::sin(0.5 * (x - dx)) + 60.0 * std::sin(0.4 * (y - dy));
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<std::uint8_t>(std::lround(value));
    }
  }
  return image;
}

TEST(ShiftBetween, FindsAMoveToAFractionOfAPixel) {
  const hal::Image mask = uniform_mask(60, 40);
  for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {2.0, -3.0}, {0.4, 0.0}, {-1.3, 2.6}}) {
    const Eigen::Vector2d shift = shift_between(waves(0.0, 0.0), waves(dx, dy), mask, 4);
    EXPECT_NEAR(shift.x(), dx, 0.1);
    EXPECT_NEAR(shift.y(), dy, 0.1);
  }
}

TEST(ShiftBetween, LooksNoFartherThanItsReachAndAtTheMaskOnly) {
  const hal::Image a = waves(0.0, 0.0);
  const hal::Image mask = uniform_mask(60, 40);
  EXPECT_LE(std::abs(shift_between(a, waves(5.0, 0.0), mask, 2).x()), 2.5);
  hal::Image half = waves(2.0, 0.0);  // the left half has moved, the right one has not
  hal::Image left(60, 40, 1);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) {
      if (x < 30) *left.at(x, y) = 255;
      if (x >= 30) std::copy_n(a.at(x, y), 3, half.at(x, y));
    }
  }
  EXPECT_NEAR(shift_between(a, half, left, 4).x(), 2.0, 0.2);
  EXPECT_EQ(shift_between(a, half, hal::Image(60, 40, 1), 4), Eigen::Vector2d::Zero());
  EXPECT_EQ(shift_between(a, uniform(20, 10, 100), mask, 4), Eigen::Vector2d::Zero());
}

TEST(PatchDifference, SeesAPatchAndHardlyAShift) {
  const hal::Image a = waves(0.0, 0.0);
  const hal::Image mask = uniform_mask(60, 40);
  EXPECT_EQ(patch_difference(a, a, mask), 0.0);
  EXPECT_NEAR(patch_difference(uniform(60, 40, 100), uniform(60, 40, 130), mask), 30.0, 1e-9);
  hal::Image patched = a;
  for (int y = 10; y < 30; ++y) {
    for (int x = 10; x < 35; ++x) {
      for (int c = 0; c < 3; ++c)
        patched.at(x, y)[c] = static_cast<std::uint8_t>(a.at(x, y)[c] / 4);
    }
  }
  EXPECT_GT(patch_difference(a, patched, mask), 60.0);
  const auto fine = [](double dx) {
    hal::Image image(60, 40, 3);
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 60; ++x) {
        const double value = 128.0 + 80.0 * std::sin(2.0 * (x - dx)) * std::sin(2.2 * y);
        for (int c = 0; c < 3; ++c) {
          image.at(x, y)[c] = static_cast<std::uint8_t>(std::lround(value));
        }
      }
    }
    return image;
  };
  EXPECT_LT(patch_difference(fine(0.0), fine(1.0), mask), 15.0);
  EXPECT_TRUE(std::isnan(patch_difference(a, a, hal::Image(60, 40, 1))));
  EXPECT_TRUE(std::isnan(patch_difference(a, uniform(20, 10, 100), mask)));
}

TEST(BoxOf, IsTheSmallestThatHoldsAll) {
  hal::Image mask(20, 10, 1);
  EXPECT_TRUE(box_of(mask).empty());
  *mask.at(3, 8) = 255;
  *mask.at(7, 2) = 1;
  const Box box = box_of(mask);
  EXPECT_EQ(box.left, 3);
  EXPECT_EQ(box.right, 7);
  EXPECT_EQ(box.width(), 5);
  EXPECT_EQ(box.top, 2);
  EXPECT_EQ(box.height(), 7);
}

TEST(SubjectMask, HasTheAreaOfTheSpheresOutline) {
  const View view{test::make_camera(400, 300), test::look_at({0, 0, -5}, {0, 0, 0})};
  const hal::Image mask = subject_mask(view, {Eigen::Vector3d::Zero(), 1.0});
  double area = 0.0;
  for (std::size_t i = 0; i < mask.size_bytes(); ++i) area += mask.data()[i] != 0 ? 1.0 : 0.0;
  // The outline is a cone of half angle asin(1/5).
  const double radius = view.camera.profile().fx * std::tan(std::asin(0.2));
  EXPECT_NEAR(area, std::numbers::pi * radius * radius, 0.01 * area);
  EXPECT_EQ(*mask.at(200, 150), 255);
  EXPECT_EQ(*mask.at(0, 0), 0);
}

TEST(SubjectMask, InsideIsEverywhereBehindIsNowhere) {
  const geometry::Camera camera = test::make_camera(40, 30);
  const lightfield::Sphere sphere{Eigen::Vector3d::Zero(), 1.0};
  const hal::Image inside = subject_mask({camera, test::look_at({0, 0, 0.5}, {0, 0, 9})}, sphere);
  const hal::Image behind = subject_mask({camera, test::look_at({0, 0, 3}, {0, 0, 9})}, sphere);
  EXPECT_TRUE(std::all_of(inside.data(), inside.data() + inside.size_bytes(),
                          [](std::uint8_t value) { return value == 255; }));
  EXPECT_EQ(behind, hal::Image(40, 30, 1));
}

}  // namespace
}  // namespace lumibox::render
