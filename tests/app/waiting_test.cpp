// A box that is switched on before its webcam or its screen is plugged in.

#include "app/waiting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "config/error.h"
#include "hal/fake_video.h"
#include "hal/offscreen/offscreen_display.h"
#include "hal/scripted/scripted_buttons.h"
#include "hal/sim/virtual_clock.h"
#include "hal/v4l2/v4l2_camera.h"

namespace lumibox::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::int64_t kTick_ns = 100'000'000;

class WaitingTest : public ::testing::Test {
 protected:
  WaitingTest() {
    devices_.clock = std::make_unique<hal::VirtualClock>();
    devices_.buttons = std::make_unique<hal::ScriptedButtons>(
        std::vector<hal::ButtonEvent>{
            {hal::Button::Main, hal::ButtonAction::Pressed, 5 * kTick_ns}},
        *devices_.clock);
    devices_.open_camera = [this] {
      hal::CameraOptions options;
      options.wishes.width = 32;
      options.wishes.height = 24;
      ++looks_;
      return std::make_unique<hal::V4l2Camera>(
          options, *devices_.clock,
          std::make_unique<testing::FakeVideo>(*devices_.clock, std::vector{webcam_}),
          hal::Service::Caller);
    };
    devices_.open_display = [this]() -> std::unique_ptr<hal::Display> {
      if (!has_screen_) throw config::Unavailable("display kms: no screen is connected");
      auto display = std::make_unique<hal::OffscreenDisplay>(320, 240);
      display->make_current();
      screen_ = display.get();
      return display;
    };
  }

  Waiting& begin() {
    open_missing(devices_);
    return waiting_.emplace(devices_, config::Config());
  }

  void pass(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      devices_.clock->wait_until(devices_.clock->now_ns() + kTick_ns);
      waiting_->tick();
    }
  }

  /// Whether letters are on the screen.
  bool says_something() const {
    const hal::Image picture = screen_->read_back();
    return std::any_of(picture.data(), picture.data() + picture.size_bytes(),
                       [](std::uint8_t level) { return level > 128; });
  }

  std::shared_ptr<testing::FakeCamera> webcam_ = std::make_shared<testing::FakeCamera>();
  bool has_screen_ = true;
  int looks_ = 0;
  hal::OffscreenDisplay* screen_ = nullptr;
  Devices devices_;
  std::optional<Waiting> waiting_;
};

TEST_F(WaitingTest, IsOverAtOnceWhereNothingIsMissing) {
  EXPECT_TRUE(begin().over());
}

TEST_F(WaitingTest, SaysOnTheScreenWhichCameraIsMissingUntilItIsPluggedIn) {
  webcam_->unplug();
  begin();
  pass(1);
  EXPECT_THAT(waiting_->picture().alerts, ElementsAre(HasSubstr("no camera found")));
  EXPECT_TRUE(says_something());
  EXPECT_EQ(waiting_->presented(), 1) << "the service manager must hear of it";
  pass(200);
  EXPECT_FALSE(waiting_->over());
  EXPECT_EQ(waiting_->presented(), 201);
  EXPECT_EQ(looks_, 21) << "once a second";
  webcam_->plug();
  pass(10);
  ASSERT_TRUE(waiting_->over());
  devices_.clock->wait_until(devices_.clock->now_ns() + kTick_ns);
  EXPECT_TRUE(devices_.camera->take_newest()) << "it streams";
}

TEST_F(WaitingTest, TheReasonIsTheNewest) {
  webcam_->unplug();
  begin();
  webcam_->plug();
  webcam_->busy_error = EBUSY;
  pass(11);
  EXPECT_THAT(waiting_->picture().alerts, ElementsAre(HasSubstr("another program")));
  EXPECT_EQ(webcam_->open, 0) << "nor is it kept from others";
  webcam_->busy_error = 0;
  pass(10);
  EXPECT_TRUE(waiting_->over());
}

TEST_F(WaitingTest, WithoutAScreenItIsAliveAndTheCameraRests) {
  has_screen_ = false;
  begin();
  pass(20);
  EXPECT_EQ(waiting_->presented(), 20);
  EXPECT_EQ(waiting_->picture().title, "no screen");
  EXPECT_EQ(webcam_->streams, 0);
  has_screen_ = true;
  pass(10);
  EXPECT_TRUE(waiting_->over());
  EXPECT_EQ(webcam_->streams, 1);
}

TEST_F(WaitingTest, WithNeitherFirstTheScreenMayCome) {
  has_screen_ = false;
  webcam_->unplug();
  begin();
  pass(20);
  has_screen_ = true;
  const std::int64_t before = waiting_->presented();
  pass(10);
  EXPECT_FALSE(waiting_->over());
  EXPECT_TRUE(says_something());
  EXPECT_GT(waiting_->presented(), before);
  webcam_->plug();
  pass(10);
  EXPECT_TRUE(waiting_->over());
}

TEST_F(WaitingTest, SaysWhatElseIsWrong) {
  webcam_->unplug();
  begin();
  waiting_->always_show("on the last good settings: lumibox.toml:2: no TOML");
  pass(2);
  EXPECT_THAT(waiting_->picture().alerts,
              ElementsAre(HasSubstr("lumibox.toml:2"), HasSubstr("no camera found")));
}

TEST_F(WaitingTest, WhatIsPressedMeanwhileIsForgotten) {
  webcam_->unplug();
  begin();
  pass(10);
  EXPECT_TRUE(devices_.buttons->poll().empty());
}

TEST_F(WaitingTest, WhatIsLoggedIsLoggedOnce) {
  webcam_->unplug();
  ::testing::internal::CaptureStdout();
  begin();
  pass(50);
  webcam_->busy_error = EBUSY;
  webcam_->plug();
  pass(50);
  webcam_->busy_error = 0;
  pass(10);
  const std::string said = ::testing::internal::GetCapturedStdout();
  for (const char* words :
       {"waiting: devices.camera: no camera found", "is another program using it?",
        "the box has its camera and its screen", "chosen: mjpeg 32x24"}) {
    EXPECT_THAT(said, HasSubstr(words));
    EXPECT_EQ(said.find(words), said.rfind(words)) << words;
  }
}

TEST_F(WaitingTest, WhatNoPlugCanMendIsThrown) {
  webcam_->unplug();
  begin();
  devices_.open_camera = []() -> std::unique_ptr<hal::Camera> {
    throw config::InputError("camera.width: expected another");
  };
  EXPECT_THROW(pass(10), config::InputError);
}

}  // namespace
}  // namespace lumibox::app
