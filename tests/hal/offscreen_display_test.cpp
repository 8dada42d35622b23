#include "hal/offscreen/offscreen_display.h"

#include <GLES3/gl3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "config/error.h"
#include "support/input_error.h"

namespace lumibox::hal {
namespace {

std::unique_ptr<OffscreenDisplay> open(int width, int height) {
  try {
    return std::make_unique<OffscreenDisplay>(width, height);
  } catch (const config::InputError& error) {
    std::cerr << error.what() << '\n';
    return nullptr;
  }
}

void clear(float red, float green, float blue) {
  glClearColor(red, green, blue, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
}

TEST(OffscreenDisplay, ReadsBackAClearColourExactly) {
  const auto display = open(37, 21);  // odd: rows are not a multiple of four bytes
  if (!display) GTEST_SKIP() << "no EGL here";
  display->make_current();
  glBindFramebuffer(GL_FRAMEBUFFER, display->framebuffer());
  clear(1.0F, 0.2F, 0.0F);
  display->present();
  const Image image = display->read_back();
  ASSERT_EQ(image.width(), 37);
  ASSERT_EQ(image.height(), 21);
  ASSERT_EQ(image.channels(), 3);
  for (std::size_t i = 0; i < image.size_bytes(); i += 3) {
    ASSERT_EQ(image.data()[i], 255);
    ASSERT_EQ(image.data()[i + 1], 51);
    ASSERT_EQ(image.data()[i + 2], 0);
  }
}

// A gradient drawn with scissored clears needs no shader: column x is red x, row y from the bottom
// is green y. The top row of the picture must come first.
TEST(OffscreenDisplay, ReadsBackAGradientTopRowFirst) {
  const auto display = open(64, 48);
  if (!display) GTEST_SKIP() << "no EGL here";
  display->make_current();
  glBindFramebuffer(GL_FRAMEBUFFER, display->framebuffer());
  glEnable(GL_SCISSOR_TEST);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      glScissor(x, y, 1, 1);
      clear(static_cast<float>(x) / 255.0F, static_cast<float>(y) / 255.0F, 0.0F);
    }
  }
  const Image image = display->read_back();
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      ASSERT_EQ(image.at(x, y)[0], x);
      ASSERT_EQ(image.at(x, y)[1], 47 - y);
    }
  }
}

TEST(OffscreenDisplay, TwoLiveSideBySideAndOneOutlivesTheOther) {
  const auto first = open(8, 8);
  if (!first) GTEST_SKIP() << "no EGL here";
  first->make_current();
  glBindFramebuffer(GL_FRAMEBUFFER, first->framebuffer());
  clear(0.0F, 1.0F, 0.0F);
  {
    OffscreenDisplay second(4, 4);
    second.make_current();
    glBindFramebuffer(GL_FRAMEBUFFER, second.framebuffer());
    clear(0.0F, 0.0F, 1.0F);
    EXPECT_EQ(second.read_back().data()[2], 255);
  }
  EXPECT_EQ(first->read_back().data()[1], 255);
}

TEST(OffscreenDisplay, MayBeMadeHereAndUsedOnAnotherThread) {
  const auto display = open(8, 8);
  if (!display) GTEST_SKIP() << "no EGL here";
  std::thread([&] {
    display->make_current();
    glBindFramebuffer(GL_FRAMEBUFFER, display->framebuffer());
    clear(1.0F, 1.0F, 1.0F);
    EXPECT_EQ(display->read_back().data()[0], 255);
  }).join();
}

TEST(OffscreenDisplay, AfterALossANewContextTakesItsPlace) {
  const auto display = open(8, 8);
  if (!display) GTEST_SKIP() << "no EGL here";
  display->make_current();
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  display->present();
  EXPECT_FALSE(display->lost());
  display->lose();
  EXPECT_EQ(glIsTexture(texture), GL_FALSE);
  display->present();
  display->make_current();
  EXPECT_TRUE(display->lost()) << "until it is made anew";
  display->renew();
  EXPECT_FALSE(display->lost());
  EXPECT_EQ(glIsTexture(texture), GL_FALSE);
  glBindFramebuffer(GL_FRAMEBUFFER, display->framebuffer());
  clear(0.0F, 1.0F, 0.0F);
  display->present();
  EXPECT_FALSE(display->lost());
  EXPECT_EQ(display->read_back().at(3, 3)[1], 255);
}

TEST(OffscreenDisplay, ImpossibleSizeIsRefused) {
  if (!open(8, 8)) GTEST_SKIP() << "no EGL here";
  for (const auto& [width, height] : {std::pair{0, 8}, {8, -1}, {1 << 30, 8}}) {
    EXPECT_THAT(testing::message_of([&] { OffscreenDisplay(width, height); }),
                ::testing::HasSubstr("offscreen display of " + std::to_string(width)));
  }
}

}  // namespace
}  // namespace lumibox::hal
