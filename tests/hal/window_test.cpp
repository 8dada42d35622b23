#include <GLES3/gl3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <cstdlib>

#include "config/error.h"
#include "hal/desk.h"
#include "hal/sim/virtual_clock.h"
#include "hal/window/window_buttons.h"
#include "hal/window/window_display.h"
#include "support/input_error.h"

namespace lumibox::hal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kStuckS = 60.0;
/// Pictures by which what the desktop does has come to a window; most come with the first.
constexpr int kMostPictures = 1000;

class WindowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!desk_) GTEST_SKIP() << "no desktop here; Debian's package xvfb has one for tests";
    display_ = std::make_unique<WindowDisplay>(60, 40, keys_, clock_);
    display_->make_current();
  }

  void show(float red, float green, float blue) {
    glBindFramebuffer(GL_FRAMEBUFFER, display_->framebuffer());
    glClearColor(red, green, blue, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    display_->present();
    glFinish();
  }

  /// Shows pictures until it is so.
  template <typename Condition>
  bool until(Condition condition) {
    for (int i = 0; i < kMostPictures; ++i) {
      if (condition()) return true;
      show(0.0F, 0.0F, 1.0F);
    }
    return false;
  }

  VirtualClock clock_;
  std::shared_ptr<KeyEdges> keys_ = std::make_shared<KeyEdges>();
  testing::Desktop desktop_;
  std::unique_ptr<testing::Desk> desk_ = testing::Desk::open();
  std::unique_ptr<WindowDisplay> display_;
};

TEST_F(WindowTest, ShowsThePicture) {
  EXPECT_EQ(display_->width(), 60);
  EXPECT_EQ(display_->height(), 40);
  show(1.0F, 0.2F, 0.0F);
  EXPECT_THAT(desk_->color_at(30, 20), ElementsAre(255, 51, 0));
  EXPECT_EQ(display_->presented(), 1);
  EXPECT_FALSE(display_->lost());
}

TEST_F(WindowTest, ThePictureKeepsItsShapeWhenTheWindowIsResized) {
  show(0.0F, 0.0F, 1.0F);
  desk_->resize(240, 80);
  ASSERT_TRUE(until([&] { return desk_->color_at(120, 70)[2] == 255; }));
  ASSERT_TRUE(until([&] { return desk_->color_at(10, 40)[2] == 0; }));
  EXPECT_THAT(desk_->color_at(120, 70), ElementsAre(0, 0, 255));
  EXPECT_THAT(desk_->color_at(61, 5), ElementsAre(0, 0, 255));
  EXPECT_THAT(desk_->color_at(58, 5), ElementsAre(0, 0, 0)) << "beside the picture";
  EXPECT_THAT(desk_->color_at(182, 40), ElementsAre(0, 0, 0));
  EXPECT_EQ(display_->width(), 60) << "of the picture, which stays as it is";
}

TEST_F(WindowTest, WhatIsTypedIsItsButtons) {
  WindowButtons buttons(keys_, config::Evdev{}, kStuckS, clock_);
  show(0.0F, 0.0F, 1.0F);
  clock_.wait_until(1000);
  desk_->type(KEY_R, true);
  desk_->type(KEY_Q, true);
  desk_->type(KEY_R, false);
  ASSERT_TRUE(until([&] { return keys_->size() >= 3; }));
  EXPECT_THAT(buttons.poll(),
              ElementsAre(ButtonEvent{Button::Review, ButtonAction::Pressed, 1000},
                          ButtonEvent{Button::Review, ButtonAction::Released, 1000}));
  EXPECT_THAT(*keys_, IsEmpty());
}

TEST_F(WindowTest, NobodyNeedListen) {
  const std::weak_ptr<KeyEdges> heard = keys_;
  keys_.reset();
  EXPECT_TRUE(heard.expired());
  desk_->type(KEY_R, true);
  desk_->close();
  EXPECT_TRUE(until([&] { return display_->closed(); }));
}

TEST_F(WindowTest, IsClosedByWhoeverLooks) {
  show(0.0F, 0.0F, 1.0F);
  EXPECT_FALSE(display_->closed());
  desk_->close();
  EXPECT_TRUE(until([&] { return display_->closed(); }));
}

TEST_F(WindowTest, IsOpenedAnew) {
  show(0.0F, 0.0F, 1.0F);
  display_->renew();
  show(0.0F, 1.0F, 0.0F);
  EXPECT_THAT(desk_->color_at(30, 20), ElementsAre(0, 255, 0));
}

TEST(Window, IsRefusedWithoutADesktop) {
  const char* const desktop = std::getenv("DISPLAY");
  const std::string before = desktop == nullptr ? "" : desktop;
  unsetenv("DISPLAY");
  const VirtualClock clock;
  EXPECT_THAT(testing::message_of([&] { WindowDisplay(60, 40, {}, clock); }),
              ::testing::AllOf(HasSubstr("display window: looking for a desktop failed"),
                               HasSubstr("expected a desktop")));
  if (desktop != nullptr) setenv("DISPLAY", before.c_str(), 1);
}

TEST(WindowButtons, AKeyOfNoButtonAndOneThatRepeatsSayNothing) {
  VirtualClock clock;
  const auto keys = std::make_shared<KeyEdges>();
  WindowButtons buttons(keys, config::Evdev{}, kStuckS, clock);
  *keys = {{KEY_Q, true, 0}, {KEY_ENTER, true, 0}, {KEY_ENTER, true, 0}, {KEY_SPACE, true, 0}};
  EXPECT_THAT(buttons.poll(), ElementsAre(ButtonEvent{Button::Main, ButtonAction::Pressed, 0}));
  *keys = {{KEY_ENTER, false, 0}};
  EXPECT_THAT(buttons.poll(), IsEmpty()) << "the other key still holds it";
  *keys = {{KEY_SPACE, false, 0}};
  EXPECT_THAT(buttons.poll(), ElementsAre(ButtonEvent{Button::Main, ButtonAction::Released, 0}));
}

}  // namespace
}  // namespace lumibox::hal
