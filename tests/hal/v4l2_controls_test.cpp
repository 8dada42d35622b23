#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "hal/fake_video.h"
#include "hal/sim/virtual_clock.h"
#include "hal/v4l2/controls.h"

namespace lumibox::hal::v4l2 {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using testing::FakeCamera;
using testing::FakeVideo;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class V4l2Controls : public ::testing::Test {
 protected:
  V4l2Controls() { camera_->controls = testing::webcam_controls(); }

  std::int32_t value(std::uint32_t id) const { return camera_->controls.at(id).value; }

  /// Where a write of a value to a control stands among all writes; -1 if there was none.
  std::ptrdiff_t place_of(std::uint32_t id, std::int32_t value) const {
    const auto found = std::ranges::find(camera_->writes, std::pair(id, value));
    return found == camera_->writes.end() ? -1 : found - camera_->writes.begin();
  }

  VirtualClock clock_;
  std::shared_ptr<FakeCamera> camera_ = std::make_shared<FakeCamera>();
  FakeVideo video_{clock_, {camera_}};
  std::unique_ptr<VideoDevice> device_ = video_.open(camera_->path).device;
  ExposureHold hold_;
};

TEST_F(V4l2Controls, EverythingAutomaticIsHeldAtItsPresentValue) {
  EXPECT_THAT(hold_.hold(*device_), IsEmpty());
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 0);
  EXPECT_EQ(value(V4L2_CID_FOCUS_ABSOLUTE), 40);
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_ABSOLUTE), 156);
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO_PRIORITY), 0);
  EXPECT_EQ(value(V4L2_CID_AUTO_WHITE_BALANCE), 0);
  EXPECT_EQ(value(V4L2_CID_WHITE_BALANCE_TEMPERATURE), 4600);
  EXPECT_EQ(hold_.description(), "focus 40, exposure 156, white balance 4600");
}

// The fake, as webcams do, refuses a focus while its autofocus is on.
TEST_F(V4l2Controls, AnAutomatismIsSwitchedOffBeforeItsValueIsSet) {
  hold_.hold(*device_);
  const std::ptrdiff_t off = place_of(V4L2_CID_FOCUS_AUTO, 0);
  const std::ptrdiff_t set = place_of(V4L2_CID_FOCUS_ABSOLUTE, 40);
  ASSERT_GE(off, 0);
  EXPECT_LT(off, set);
}

TEST_F(V4l2Controls, IsFreedToWhatItWas) {
  camera_->controls[V4L2_CID_AUTO_WHITE_BALANCE].value = 0;  // somebody set it by hand
  hold_.hold(*device_);
  EXPECT_THAT(hold_.free(*device_), IsEmpty());
  EXPECT_FALSE(hold_.holds());
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 1);
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_APERTURE_PRIORITY);
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO_PRIORITY), 1);
  EXPECT_EQ(value(V4L2_CID_AUTO_WHITE_BALANCE), 0);
}

TEST_F(V4l2Controls, AfterTheDeviceForgotTheSameIsHeldAgain) {
  hold_.hold(*device_);
  camera_->controls = testing::webcam_controls();
  camera_->controls[V4L2_CID_FOCUS_ABSOLUTE].value = 99;
  EXPECT_THAT(hold_.hold(*device_), IsEmpty());
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 0);
  EXPECT_EQ(value(V4L2_CID_FOCUS_ABSOLUTE), 40);
}

TEST_F(V4l2Controls, WhatWasLeftHeldIsAutomaticAgain) {
  EXPECT_THAT(make_automatic(*device_).switched, IsEmpty());
  EXPECT_THAT(camera_->writes, IsEmpty()) << "nothing is set that need not be";
  hold_.hold(*device_);  // and then a crash
  const Automatic automatic = make_automatic(*device_);
  EXPECT_THAT(automatic.switched,
              ElementsAre("automatic exposure", "automatic white balance", "exposure before rate"));
  EXPECT_THAT(automatic.faults, IsEmpty());
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 0) << "a calibration may stand on it";
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_APERTURE_PRIORITY);
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO_PRIORITY), 1);
  EXPECT_EQ(value(V4L2_CID_AUTO_WHITE_BALANCE), 1);
}

TEST_F(V4l2Controls, WhatIsManualByDefaultOrCannotBeSetStaysSo) {
  hold_.hold(*device_);
  camera_->controls[V4L2_CID_AUTO_WHITE_BALANCE].usual = 0;
  camera_->controls[V4L2_CID_EXPOSURE_AUTO_PRIORITY].stubborn = true;
  const Automatic automatic = make_automatic(*device_);
  EXPECT_THAT(automatic.faults,
              ElementsAre(HasSubstr("exposure before rate is not set to 1: it is 0")));
  EXPECT_EQ(value(V4L2_CID_AUTO_WHITE_BALANCE), 0);
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_APERTURE_PRIORITY);
}

TEST_F(V4l2Controls, WhatACameraLacksIsLeftOut) {
  camera_->controls.erase(V4L2_CID_FOCUS_AUTO);
  camera_->controls.erase(V4L2_CID_FOCUS_ABSOLUTE);
  camera_->controls[V4L2_CID_EXPOSURE_AUTO].entries = {V4L2_EXPOSURE_APERTURE_PRIORITY};
  EXPECT_THAT(hold_.hold(*device_), IsEmpty());
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_APERTURE_PRIORITY);
  EXPECT_EQ(hold_.description(), "white balance 4600");

  camera_->controls.clear();
  ExposureHold nothing;
  EXPECT_THAT(nothing.hold(*device_), IsEmpty());
  EXPECT_EQ(nothing.description(), "nothing");
  EXPECT_THAT(nothing.free(*device_), IsEmpty());
}

TEST_F(V4l2Controls, ARefusalIsTriedAgainAFewTimes) {
  camera_->controls[V4L2_CID_FOCUS_AUTO].refusals = 2;
  EXPECT_THAT(hold_.hold(*device_), IsEmpty());
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 0);

  camera_->controls[V4L2_CID_EXPOSURE_AUTO].refusals = 3;
  EXPECT_THAT(hold_.free(*device_), ElementsAre(HasSubstr("automatic exposure is not set to 3")));
}

TEST_F(V4l2Controls, AValueThatDoesNotStickIsSaid) {
  camera_->controls[V4L2_CID_FOCUS_AUTO].stubborn = true;
  EXPECT_THAT(hold_.hold(*device_), ElementsAre(HasSubstr("autofocus is not set to 0: it is 1"),
                                                HasSubstr("focus is not set to 40")));
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);  // the others are held
}

TEST_F(V4l2Controls, PowerLineFrequenciesHaveNames) {
  EXPECT_EQ(power_line_setting("50hz")->value, V4L2_CID_POWER_LINE_FREQUENCY_50HZ);
  EXPECT_EQ(power_line_setting("auto")->value, V4L2_CID_POWER_LINE_FREQUENCY_AUTO);
  EXPECT_FALSE(power_line_setting("asis"));
  EXPECT_THAT(set_controls(*device_, {*power_line_setting("50hz")}), IsEmpty());
  EXPECT_EQ(value(V4L2_CID_POWER_LINE_FREQUENCY), V4L2_CID_POWER_LINE_FREQUENCY_50HZ);
}

TEST_F(V4l2Controls, AreListedWithTheirRanges) {
  const std::vector<Control> controls = list_controls(*device_);
  ASSERT_EQ(controls.size(), camera_->controls.size());
  EXPECT_EQ(controls.front().name, "White Balance, Automatic");
  const auto focus =
      std::ranges::find(controls, std::uint32_t{V4L2_CID_FOCUS_ABSOLUTE}, &Control::id);
  ASSERT_NE(focus, controls.end());
  EXPECT_EQ(focus->most, 250);
  EXPECT_EQ(focus->value, 40);
}

}  // namespace
}  // namespace lumibox::hal::v4l2
