#include "hal/image.h"

#include <gtest/gtest.h>

namespace lumibox::hal {
namespace {

Image one_pixel(int red, int green, int blue) {
  Image image(1, 1, 3);
  image.data()[0] = static_cast<std::uint8_t>(red);
  image.data()[1] = static_cast<std::uint8_t>(green);
  image.data()[2] = static_cast<std::uint8_t>(blue);
  return image;
}

TEST(Image, LumaOfGreyIsThatGrey) {
  for (int level = 0; level < 256; ++level) {
    EXPECT_EQ(to_gray(one_pixel(level, level, level)).data()[0], level);
  }
}

// Rec. 601: 0.299, 0.587 and 0.114 of 255, rounded.
TEST(Image, LumaOfPrimaries) {
  EXPECT_EQ(to_gray(one_pixel(255, 0, 0)).data()[0], 76);
  EXPECT_EQ(to_gray(one_pixel(0, 255, 0)).data()[0], 150);
  EXPECT_EQ(to_gray(one_pixel(0, 0, 255)).data()[0], 29);
}

TEST(Image, GreyToColourAndBackIsTheSame) {
  Image gray(7, 5, 1);
  for (std::size_t i = 0; i < gray.size_bytes(); ++i) {
    gray.data()[i] = static_cast<std::uint8_t>(7 * i);
  }
  EXPECT_EQ(to_rgb(gray).channels(), 3);
  EXPECT_EQ(to_gray(to_rgb(gray)), gray);
  EXPECT_EQ(to_gray(gray), gray);
  EXPECT_EQ(to_rgb(to_rgb(gray)), to_rgb(gray));
}

TEST(Image, PixelsLieWhereRowAndColumnSay) {
  Image image(4, 3, 3);
  EXPECT_EQ(image.at(2, 1) - image.data(), (1 * 4 + 2) * 3);
  EXPECT_EQ(image.row(2) - image.data(), 2 * 4 * 3);
  EXPECT_TRUE(Image().empty());
}

}  // namespace
}  // namespace lumibox::hal
