#include "app/screen.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lumibox::app {
namespace {

TEST(FittedCamera, OfTheSameSizeIsTheUndistortedCamera) {
  config::CameraProfile profile;
  profile.k1 = -0.3;
  profile.cx = 300.0;
  const geometry::Camera fitted = fitted_camera(geometry::Camera(profile), 640, 480);
  EXPECT_FALSE(fitted.has_distortion());
  EXPECT_EQ(fitted.profile().fx, profile.fx);
  EXPECT_EQ(fitted.profile().cx, profile.cx);
}

TEST(FittedCamera, ShowsTheWholePictureInTheMiddle) {
  config::CameraProfile profile;  // 640x480
  const geometry::Camera camera(profile);
  const geometry::Camera wide = fitted_camera(camera, 1000, 240);
  const auto corner_of = [&](double u, double v) {
    return *wide.project(camera.unproject({u, v})->homogeneous());
  };
  // Edges of pixels, not their centres, meet the edges of the display.
  EXPECT_NEAR(corner_of(-0.5, -0.5).y(), -0.5, 1e-9);
  EXPECT_NEAR(corner_of(639.5, 479.5).y(), 239.5, 1e-9);
  EXPECT_NEAR(corner_of(-0.5, 0.0).x(), 339.5, 1e-9);
  EXPECT_NEAR(corner_of(639.5, 0.0).x(), 659.5, 1e-9);
}

TEST(TextOf, APictureFitsTheDisplayWhateverItSays) {
  Picture picture;
  picture.title = "aim at the subject";
  for (int i = 0; i < 30; ++i) picture.advice += "words ";
  picture.details = "likeness 27.4 dB of 61   12 missing";
  picture.alerts = {picture.advice};
  const std::vector<render::Text> lines = text_of(picture, 640, 480);
  EXPECT_EQ(lines[1].utf8, picture.details);
  EXPECT_GT(lines[1].y - lines[1].size, lines[0].y);
  ASSERT_GT(lines.size(), 5U);
  float alerts_end = 0.0F;
  float advice_begin = 480.0F;
  for (const render::Text& line : lines) {
    const auto letters = static_cast<float>(line.utf8.size());
    EXPECT_LE(line.x + 0.6F * line.size * letters, 640.0F) << line.utf8;
    EXPECT_LE(line.y, 480.0F - 0.5F * line.size) << line.utf8;
    const bool is_advice = line.color.g > 0.5F && line.color.b < 0.5F;
    if (is_advice) {
      advice_begin = std::min(advice_begin, line.y - line.size);
    } else {
      alerts_end = std::max(alerts_end, line.y);
    }
  }
  EXPECT_LT(alerts_end, advice_begin);
  EXPECT_LT(advice_begin, 480.0F) << "the advice is there";
}

TEST(Wrapped, BreaksBetweenWordsAndWithinThoseThatAreTooLong) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(wrapped("", 5), Lines{""});
  EXPECT_EQ(wrapped("short", 5), Lines{"short"});
  EXPECT_EQ(wrapped("not stored: full", 11), (Lines{"not stored:", "full"}));
  EXPECT_EQ(wrapped("not stored: full", 12), (Lines{"not stored:", "full"}));
  EXPECT_EQ(wrapped("in /a/path/that/is/long", 8), (Lines{"in", "/a/path/", "that/is/", "long"}));
}

}  // namespace
}  // namespace lumibox::app
