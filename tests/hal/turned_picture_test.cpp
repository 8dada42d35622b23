#include "hal/kms/turned_picture.h"

#include <GLES3/gl3.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "config/error.h"
#include "hal/kms/virtual_terminal.h"
#include "hal/offscreen/offscreen_display.h"

namespace lumibox::hal::kms {
namespace {

constexpr std::array kRotations = {Rotation::None, Rotation::Quarter, Rotation::Half,
                                   Rotation::ThreeQuarters};

TEST(Rotation, IsQuarterTurnsOnly) {
  EXPECT_EQ(rotation_of(0), Rotation::None);
  EXPECT_EQ(rotation_of(270), Rotation::ThreeQuarters);
  EXPECT_FALSE(rotation_of(45));
  EXPECT_FALSE(rotation_of(360));
}

TEST(Rotation, APictureIsPlacedInTheMiddleAsLargeAsItGets) {
  EXPECT_EQ(placed({640, 480}, Rotation::None, {640, 480}), (Area{0, 0, {640, 480}}));
  EXPECT_EQ(placed({480, 640}, Rotation::Quarter, {640, 480}), (Area{0, 0, {640, 480}}));
  EXPECT_EQ(placed({640, 480}, Rotation::None, {1920, 1080}), (Area{240, 0, {1440, 1080}}));
  EXPECT_EQ(placed({640, 480}, Rotation::Quarter, {1920, 1080}), (Area{555, 0, {810, 1080}}));
}

RC_GTEST_PROP(RotationProperty, NothingIsPlacedOutsideOfThePanel, ()) {
  const auto side = [] { return *rc::gen::inRange(1, 5000); };
  const Size picture{side(), side()};
  const Size panel{side(), side()};
  const Area area = placed(picture, *rc::gen::elementOf(kRotations), panel);
  RC_ASSERT(area.x >= 0 && area.x + area.size.width <= panel.width);
  RC_ASSERT(area.y >= 0 && area.y + area.size.height <= panel.height);
  RC_ASSERT(area.size.width == panel.width || area.size.height == panel.height);
}

/// A panel without a screen behind it; null without EGL.
std::unique_ptr<OffscreenDisplay> panel_of(Size size) {
  try {
    auto panel = std::make_unique<OffscreenDisplay>(size.width, size.height);
    panel->make_current();
    return panel;
  } catch (const config::InputError&) {
    return nullptr;
  }
}

/// Pixel x, y (from the top left) has red 10 x + 5 and green 10 y + 5.
void draw_known_picture(const TurnedPicture& picture, Size size) {
  glBindFramebuffer(GL_FRAMEBUFFER, picture.framebuffer());
  glEnable(GL_SCISSOR_TEST);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      glScissor(x, size.height - 1 - y, 1, 1);
      glClearColor(static_cast<float>(10 * x + 5) / 255.0F, static_cast<float>(10 * y + 5) / 255.0F,
                   1.0F, 1.0F);
      glClear(GL_COLOR_BUFFER_BIT);
    }
  }
}

/// The pixel of the picture that a pixel of the panel shows; both from the top left.
std::pair<int, int> pixel_in_picture(int x, int y, Size picture, Rotation rotation) {
  switch (rotation) {
    case Rotation::None:
      break;
    case Rotation::Quarter:
      return {y, picture.height - 1 - x};
    case Rotation::Half:
      return {picture.width - 1 - x, picture.height - 1 - y};
    case Rotation::ThreeQuarters:
      return {picture.width - 1 - y, x};
  }
  return {x, y};
}

TEST(TurnedPicture, StandsOnThePanelPixelForPixelInAllFourDirections) {
  for (const Rotation rotation : kRotations) {
    const Size picture_size{12, 7};
    const Size panel_size = turned(picture_size, rotation);
    const auto panel = panel_of(panel_size);
    if (!panel) GTEST_SKIP() << "no EGL here";
    const TurnedPicture picture(picture_size);
    draw_known_picture(picture, picture_size);
    picture.put(panel->framebuffer(), panel_size, rotation);
    const Image seen = panel->read_back();
    for (int y = 0; y < panel_size.height; ++y) {
      for (int x = 0; x < panel_size.width; ++x) {
        const auto [u, v] = pixel_in_picture(x, y, picture_size, rotation);
        ASSERT_EQ(seen.at(x, y)[0], 10 * u + 5) << x << ' ' << y;
        ASSERT_EQ(seen.at(x, y)[1], 10 * v + 5) << x << ' ' << y;
        ASSERT_EQ(seen.at(x, y)[2], 255);
      }
    }
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    EXPECT_EQ(glIsEnabled(GL_SCISSOR_TEST), GL_TRUE) << "as it was";
  }
}

TEST(TurnedPicture, IsScaledWithBlackBesideItOnAPanelOfAnotherShape) {
  const Size panel_size{40, 16};
  const auto panel = panel_of(panel_size);
  if (!panel) GTEST_SKIP() << "no EGL here";
  const Size picture_size{8, 8};
  const TurnedPicture picture(picture_size);
  draw_known_picture(picture, picture_size);
  glBindFramebuffer(GL_FRAMEBUFFER, panel->framebuffer());
  glDisable(GL_SCISSOR_TEST);
  glClearColor(1.0F, 0.0F, 0.0F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  picture.put(panel->framebuffer(), panel_size, Rotation::None);
  const Image seen = panel->read_back();
  for (int y = 0; y < panel_size.height; ++y) {
    for (int x = 0; x < panel_size.width; ++x) {
      const bool inside = x >= 12 && x < 28;
      ASSERT_EQ(seen.at(x, y)[2], inside ? 255 : 0) << x << ' ' << y;
      if (!inside) {
        ASSERT_EQ(seen.at(x, y)[0], 0);
        continue;
      }
      // Pixel centres are half way between: two pixels of the panel for one of the picture.
      const double u = std::clamp((x - 12 + 0.5) / 2.0 - 0.5, 0.0, 7.0);
      ASSERT_NEAR(seen.at(x, y)[0], 10 * u + 5, 1.0) << x << ' ' << y;
    }
  }
}

TEST(VirtualTerminal, IsNothingWhereThereIsNone) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  EXPECT_EQ(VirtualTerminal::on(ends[0]), nullptr);
  const int window = posix_openpt(O_RDWR | O_NOCTTY);
  EXPECT_EQ(VirtualTerminal::on(window), nullptr);
  for (const int file : {ends[0], ends[1], window}) close(file);
}

}  // namespace
}  // namespace lumibox::hal::kms
