#include <gtest/gtest.h>

#include "appliance/box.h"
#include "lightfield/capture.h"

// A session of somebody with the box: real device nodes from the webcam to the screen, and buttons
// that are pressed.
namespace lumibox::testing {
namespace {

// The camera's picture on the screen: YUYV and back, a few lines of writing and the dots on it. The
// light field is made of others.
constexpr double kLive_dB = 26.0;
// Another picture of the film is this much less like, so the above is no accident.
constexpr double kStandsOut_dB = 6.0;
// Of the light field from where the camera is; blurred, where views are missing black.
constexpr double kRendered_dB = 12.0;

TEST(Session, FromTheFirstPictureToTheLightField) {
  Box box("session");
  box.get_devices();
  box.wait_until_ready();
  box.expect_status("aim at the subject");

  const Likeness live = likeness_to_film(box.look("session-1-looking-around"));
  note_figure("likeness of the live picture to the webcam's: " + std::to_string(live.best) + " dB");
  EXPECT_GT(live.best, kLive_dB);
  EXPECT_GT(live.best - live.median, kStandsOut_dB) << "any picture would have done";

  EXPECT_FALSE(box.lamp_is_lit());
  box.press(Line::Main);
  box.expect_status("the sphere is placed");
  box.look("session-2-sphere-placed");
  box.press(Line::Main);
  box.expect_status("capture");
  box.expect_views(12);
  EXPECT_TRUE(box.machine().becomes_true("grep -q 1 /run/box-lines/sim_gpio5/value"));
  box.look("session-3-capture");

  box.press(Line::Review);
  box.expect_status("review");
  const Likeness rendered = likeness_to_film(box.look("session-4-review"));
  note_figure("likeness of the light field to the webcam's picture: " +
              std::to_string(rendered.best) + " dB");
  EXPECT_GT(rendered.best, kRendered_dB);
  EXPECT_LT(rendered.best, live.best) << "the camera's picture is still there";
  // A keyboard's Main and Review do what the box's own do.
  box.machine().type("ret");
  box.expect_status("wide aperture");
  box.look("session-5-review-wide");
  box.machine().type("r");
  box.expect_status("capture");

  const int views = box.views();
  ASSERT_TRUE(box.machine().shut_down());
  const auto captures = captures_on(box.disk(), box.disk().parent_path() / "data");
  ASSERT_EQ(captures.size(), 1u);
  const auto capture = lightfield::load_capture(captures[0]);
  EXPECT_GE(static_cast<int>(capture.light_field.perspectives().size()), views);
}

}  // namespace
}  // namespace lumibox::testing
