#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <variant>
#include <vector>

#include "hal/fake_video.h"
#include "hal/sim/virtual_clock.h"
#include "hal/v4l2/camera_list.h"
#include "hal/v4l2/controls.h"
#include "hal/v4l2/modes.h"

namespace lumibox::hal::v4l2 {
namespace {

using live::Layout;
using live::Mode;
using live::PixelFormat;
using ::testing::ElementsAre;
using testing::FakeCamera;
using testing::FakeVideo;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> texts(const std::vector<Mode>& modes) {
  std::vector<std::string> all;
  for (const Mode& mode : modes) all.push_back(to_string(mode));
  return all;
}

/// A fake camera, opened.
class V4l2Modes : public ::testing::Test {
 protected:
  VideoDevice& device() {
    if (!device_) device_ = video_.open(camera_->path).device;
    return *device_;
  }

  VirtualClock clock_;
  std::shared_ptr<FakeCamera> camera_ = std::make_shared<FakeCamera>();
  FakeVideo video_{clock_, {camera_}};
  std::unique_ptr<VideoDevice> device_;
};

TEST_F(V4l2Modes, AllThatCanBeReadAreListed) {
  camera_->modes = {{V4L2_PIX_FMT_H264, 640, 480, {30}}, {V4L2_PIX_FMT_MJPEG, 640, 480, {30, 15}},
                    {V4L2_PIX_FMT_YUYV, 320, 240, {30}}, {V4L2_PIX_FMT_NV12, 320, 240, {25}},
                    {V4L2_PIX_FMT_GREY, 320, 240, {60}}, {V4L2_PIX_FMT_YUYV, 321, 240, {30}}};
  EXPECT_THAT(
      texts(list_modes(device(), {})),
      ElementsAre("mjpeg 640x480 at 30 Hz", "mjpeg 640x480 at 15 Hz", "yuyv 320x240 at 30 Hz",
                  "nv12 320x240 at 25 Hz", "grey 320x240 at 60 Hz"));
}

TEST_F(V4l2Modes, OfRangesTheNearestToTheWishIsListed) {
  camera_->any_size = v4l2_frmsize_stepwise{2, 1920, 2, 1, 1200, 1};
  camera_->any_rate = v4l2_frmival_stepwise{{1, 60}, {1, 5}, {1, 1}};
  const auto of = [this](int width, int height, double rate) {
    return texts(list_modes(device(), {std::nullopt, width, height, rate})).front();
  };
  EXPECT_EQ(of(640, 480, 30), "mjpeg 640x480 at 30 Hz");
  EXPECT_EQ(of(641, 480, 12.5), "mjpeg 642x480 at 12.5 Hz");
  EXPECT_EQ(of(4000, 3000, 90), "mjpeg 1920x1200 at 60 Hz");
  EXPECT_EQ(of(4000, 3000, 1), "mjpeg 1920x1200 at 5 Hz");
}

TEST_F(V4l2Modes, SizesBeyondAllReasonAreLeftOut) {
  camera_->modes = {{V4L2_PIX_FMT_MJPEG, 1 << 30, 1 << 30, {30}},
                    {V4L2_PIX_FMT_MJPEG, 640, -480, {30}},  // over four thousand million
                    {V4L2_PIX_FMT_MJPEG, 640, 480, {30}}};
  EXPECT_THAT(texts(list_modes(device(), {})), ElementsAre("mjpeg 640x480 at 30 Hz"));
}

TEST_F(V4l2Modes, RangesMayReachAsFarAsTheKernelCounts) {
  constexpr std::uint32_t kMost = 0xFFFFFFFF;
  camera_->any_rate = v4l2_frmival_stepwise{{1, 60}, {1, 5}, {1, 1}};
  const auto of = [this](const v4l2_frmsize_stepwise& range) {
    camera_->any_size = range;
    return texts(list_modes(device(), {})).front();
  };
  EXPECT_EQ(of({2, kMost, 2, 2, kMost, 2}), "mjpeg 640x480 at 30 Hz");
  EXPECT_EQ(of({2, 640, kMost, 480, kMost, kMost}), "mjpeg 2x480 at 30 Hz");
  EXPECT_EQ(of({kMost, kMost, 0, kMost, 2, 0}), "mjpeg 32768x32768 at 30 Hz") << "makes no sense";
}

TEST_F(V4l2Modes, ADriverThatNeverSaysThatThereAreNoMoreIsNotListenedToForEver) {
  camera_->endless = true;
  camera_->controls = testing::webcam_controls();
  EXPECT_EQ(list_modes(device(), {}).size(), 4096U);
  EXPECT_EQ(list_controls(device()).size(), camera_->controls.size());
  EXPECT_LT(camera_->calls, 20'000);
}

TEST_F(V4l2Modes, HalfPicturesAreRefused) {
  const Mode wished{PixelFormat::Mjpeg, 32, 24, {1, 10}};
  for (const std::uint32_t field : {V4L2_FIELD_INTERLACED, V4L2_FIELD_ALTERNATE, V4L2_FIELD_TOP}) {
    camera_->field = field;
    EXPECT_EQ(std::get<std::string>(set_mode(device(), wished)),
              "gives mjpeg 32x24 at 10 Hz interlaced; expected whole pictures (progressive)");
  }
  camera_->field = V4L2_FIELD_ANY;  // which drivers must not say, but do
  EXPECT_TRUE(std::holds_alternative<Layout>(set_mode(device(), wished)));
}

TEST_F(V4l2Modes, CamerasThatDoNotSayTheirRatesHaveOneMode) {
  camera_->modes = {{V4L2_PIX_FMT_YUYV, 640, 480, {}}};
  const std::vector<Mode> modes = list_modes(device(), {});
  EXPECT_THAT(texts(modes), ElementsAre("yuyv 640x480 at a rate that it does not say"));
  EXPECT_TRUE(live::choose(modes, {}));
}

Mode mode(PixelFormat format, int width, int height, std::uint32_t rate) {
  return {format, width, height, {1, rate}};
}

TEST_F(V4l2Modes, WhatIsSetIsChecked) {
  camera_->modes = {{V4L2_PIX_FMT_YUYV, 640, 480, {30}}};
  const Mode wished = mode(PixelFormat::Yuyv, 640, 480, 30);
  const auto layout = set_mode(device(), wished);
  ASSERT_TRUE(std::holds_alternative<Layout>(layout));
  EXPECT_EQ(std::get<Layout>(layout).stride, 1280U);
  EXPECT_EQ(std::get<Layout>(layout).size_bytes, 1280U * 480U);
  EXPECT_FALSE(std::get<Layout>(layout).limited_range);

  for (const auto& [width, height] : {std::pair(640, 360), std::pair(320, 480)}) {
    camera_->other_size = {width, height};
    EXPECT_THAT(std::get<std::string>(set_mode(device(), wished)),
                HasSubstr("gives " + std::to_string(width) + "x" + std::to_string(height)));
  }
  camera_->other_size.reset();
  EXPECT_THAT(std::get<std::string>(set_mode(device(), mode(PixelFormat::Mjpeg, 640, 480, 30))),
              HasSubstr("in yuyv"));
}

TEST_F(V4l2Modes, ARateThatTheCameraDoesNotKeepIsKnown) {
  camera_->other_interval = v4l2_fract{1, 15};
  const auto layout = set_mode(device(), mode(PixelFormat::Mjpeg, 32, 24, 30));
  EXPECT_EQ(std::get<Layout>(layout).mode.interval.rate_hz(), 15.0);
}

TEST_F(V4l2Modes, RowsMayBePaddedAndValuesOfLimitedRange) {
  camera_->modes = {{V4L2_PIX_FMT_NV12, 640, 480, {30}}};
  camera_->padding = 64;
  camera_->limited_range = true;
  const auto layout = std::get<Layout>(set_mode(device(), mode(PixelFormat::Nv12, 640, 480, 30)));
  EXPECT_EQ(layout.stride, 704U);
  EXPECT_EQ(layout.size_bytes, 704U * 720U);
  EXPECT_TRUE(layout.limited_range);
}

TEST(CameraList, SaysWhatEachCameraOffersAndLeavesOutWhatIsNone) {
  VirtualClock clock;
  const auto webcam = std::make_shared<FakeCamera>();
  webcam->stable_path = "/dev/v4l/by-id/usb-fake-index0";
  webcam->modes = {{V4L2_PIX_FMT_MJPEG, 640, 480, {15, 30}}, {V4L2_PIX_FMT_YUYV, 320, 240, {}}};
  webcam->controls[V4L2_CID_FOCUS_ABSOLUTE] = {.name = "Focus", .most = 250, .value = 40};
  const auto metadata = std::make_shared<FakeCamera>();
  metadata->path = "/dev/video1";
  metadata->capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  const auto locked = std::make_shared<FakeCamera>();
  locked->path = "/dev/video2";
  locked->open_error = EACCES;
  FakeVideo video(clock, {webcam, metadata, locked});
  EXPECT_EQ(list_cameras(video),
            "/dev/video0: Fake Webcam (fake, memory:/dev/video0)\n"
            "  /dev/v4l/by-id/usb-fake-index0\n"
            "  yuyv 320x240: at a rate that it does not say\n"
            "  mjpeg 640x480: 30, 15 Hz\n"
            "  Focus: 40 (0 to 250)\n"
            "/dev/video2: Permission denied\n");
  FakeVideo nothing(clock, {metadata});
  EXPECT_EQ(list_cameras(nothing), "");
}

}  // namespace
}  // namespace lumibox::hal::v4l2
