// The webcam backend with webcams in memory, which are unplugged, stall and lie. Nothing waits: the
// camera is looked after by whoever takes frames, and time is the test's.

#include "hal/v4l2/v4l2_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "hal/fake_video.h"
#include "hal/sim/virtual_clock.h"
#include "hal/system_clock.h"
#include "support/input_error.h"

namespace lumibox::hal {
namespace {

using ::testing::AllOf;
using testing::FakeCamera;
using testing::FakeVideo;
using ::testing::HasSubstr;
using testing::Silence;

constexpr std::int64_t kPeriodNs = 100'000'000;
constexpr std::int64_t kSecondNs = 1'000'000'000;

class V4l2CameraTest : public ::testing::Test {
 protected:
  V4l2CameraTest() {
    webcam_->controls = testing::webcam_controls();
    options_.wishes.stall_periods = 10;
    options_.wishes.rate_hz = 10;
    options_.wishes.width = 32;
    options_.wishes.height = 24;
  }

  V4l2Camera& open() {
    auto video = std::make_unique<FakeVideo>(clock_, webcams_);
    video_ = video.get();
    camera_ = std::make_unique<V4l2Camera>(options_, clock_, std::move(video), Service::Caller);
    return *camera_;
  }

  void start() { open().start(); }

  std::string complaint() {
    return testing::message_of([&] { open(); });
  }

  /// A period later: the frame of it, if there is one.
  std::optional<Frame> step() {
    clock_.wait_until(clock_.now_ns() + kPeriodNs);
    return camera_->take_newest();
  }

  /// Periods until there is a frame, at most 100; -1 if there was none.
  int periods_until_frame() {
    for (int i = 1; i <= 100; ++i) {
      if (step()) return i;
    }
    return -1;
  }

  /// Seconds until there is a frame, at most so many; none if there was none.
  void pass(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 10); ++i) step();
  }

  std::int32_t value(std::uint32_t id) const { return webcam_->controls.at(id).value; }

  VirtualClock clock_;
  std::shared_ptr<FakeCamera> webcam_ = std::make_shared<FakeCamera>();
  std::vector<std::shared_ptr<FakeCamera>> webcams_ = {webcam_};
  CameraOptions options_;
  FakeVideo* video_ = nullptr;
  std::unique_ptr<V4l2Camera> camera_;
};

config::CameraProfile profile(int width, int height) {
  config::CameraProfile p;
  p.width = width;
  p.height = height;
  p.fx = 44.0;
  return p;
}

TEST_F(V4l2CameraTest, TheCalibrationDecidesTheSizeAndTheCameraTheRate) {
  webcam_->modes = {{V4L2_PIX_FMT_MJPEG, 640, 480, {30}}, {V4L2_PIX_FMT_MJPEG, 32, 24, {25}}};
  options_.calibration = profile(32, 24);
  options_.wishes.width = options_.wishes.height = 0;
  open();
  EXPECT_EQ(camera_->profile().width, 32);
  EXPECT_EQ(camera_->profile().fx, 44.0);
  EXPECT_EQ(camera_->profile().fps, 25.0);
}

TEST_F(V4l2CameraTest, ACalibrationOfAnotherSizeIsRefusedWithTheSizesThereAre) {
  webcam_->modes = {{V4L2_PIX_FMT_MJPEG, 640, 480, {30}}, {V4L2_PIX_FMT_MJPEG, 32, 24, {25}}};
  options_.calibration = profile(320, 240);
  options_.wishes.width = options_.wishes.height = 0;
  EXPECT_THAT(complaint(), AllOf(HasSubstr("devices.camera: /dev/video0 (Fake Webcam)"),
                                 HasSubstr("no pictures of 320x240"), HasSubstr("32x24, 640x480")));
  options_.wishes.width = 640;
  EXPECT_THAT(complaint(), AllOf(HasSubstr("camera.width"), HasSubstr("320x240")));
}

TEST_F(V4l2CameraTest, WithoutACalibrationAFieldOfViewIsAssumed) {
  options_.wishes.width = 40;  // it has 32x24 only
  open();
  EXPECT_EQ(camera_->profile().width, 32);
  EXPECT_NEAR(camera_->profile().fx, 16.0 / std::tan(30.0 * 3.14159265358979 / 180.0), 1e-9);
  EXPECT_EQ(camera_->profile().cx, 15.5);
}

TEST_F(V4l2CameraTest, AFormatThatThereIsNotIsRefused) {
  options_.wishes.format = "nv12";
  EXPECT_THAT(complaint(), AllOf(HasSubstr("no nv12"), HasSubstr("mjpeg")));
}

TEST_F(V4l2CameraTest, CamerasThatCannotBeUsedAreNamedWithTheReason) {
  options_.device = "/dev/video7";
  EXPECT_THAT(complaint(), AllOf(HasSubstr("/dev/video7"), HasSubstr("No such file")));
  options_.device = "/dev/video0";
  webcam_->open_error = EACCES;
  EXPECT_THAT(complaint(), HasSubstr("group video"));
  webcam_->open_error = 0;
  webcam_->capabilities = V4L2_CAP_VIDEO_OUTPUT;
  EXPECT_THAT(complaint(), HasSubstr("no camera"));
  options_.device = "auto";
  EXPECT_THAT(complaint(), HasSubstr("no camera found"));
  options_.device = "C920";
  EXPECT_THAT(complaint(), HasSubstr("no camera named \"C920\""));
}

TEST_F(V4l2CameraTest, AnotherProgramsCameraIsSaidToBeBusy) {
  webcam_->busy_error = EBUSY;
  open();
  EXPECT_THAT(testing::message_of([&] { camera_->start(); }),
              AllOf(HasSubstr("/dev/video0"), HasSubstr("another program")));
  EXPECT_EQ(camera_->state(), CameraState::Stopped);
  webcam_->busy_error = 0;
  camera_->start();
  EXPECT_EQ(periods_until_frame(), 1);
}

TEST_F(V4l2CameraTest, IsFoundByPathStablePathPartOfItsNameOrFirst) {
  const auto metadata = std::make_shared<FakeCamera>();
  metadata->capabilities = V4L2_CAP_META_CAPTURE;
  webcam_->path = "/dev/video1";
  webcam_->stable_path = "/dev/v4l/by-id/usb-1";
  const auto other = std::make_shared<FakeCamera>();
  other->path = "/dev/video2";
  other->card = "HD Pro Webcam C920";
  webcams_ = {metadata, webcam_, other};
  for (const char* name : {"/dev/video1", "/dev/v4l/by-id/usb-1", "auto", "fake"}) {
    webcam_->opened = other->opened = 0;
    options_.device = name;
    start();
    EXPECT_GT(webcam_->streams, 0) << name;
    EXPECT_EQ(other->streams, 0) << name;
    webcam_->streams = 0;
  }
  options_.device = "c920";
  start();
  EXPECT_EQ(other->streams, 1);
}

TEST_F(V4l2CameraTest, AutoPassesOverCamerasThatDoNotHaveTheSize) {
  const auto other = std::make_shared<FakeCamera>();
  other->path = "/dev/video1";
  other->card = "Big";
  other->modes = {{V4L2_PIX_FMT_MJPEG, 64, 48, {10}}};
  webcams_ = {webcam_, other};
  options_.calibration = profile(64, 48);
  options_.wishes.width = options_.wishes.height = 0;
  start();
  EXPECT_EQ(other->streams, 1);
}

TEST_F(V4l2CameraTest, DamagedPicturesAreLeftOutAndCounted) {
  webcam_->faulty = {1};
  webcam_->cut = {3};
  webcam_->garbled = {5};
  start();
  std::vector<std::int64_t> indices;
  for (int i = 0; i < 8; ++i) {
    if (const auto frame = step()) indices.push_back(frame->index);
  }
  EXPECT_EQ(indices, (std::vector<std::int64_t>{0, 2, 4, 6, 7}));
  EXPECT_EQ(camera_->counters().delivered, 5);
  EXPECT_EQ(camera_->counters().dropped, 3);
  EXPECT_EQ(camera_->state(), CameraState::Streaming);
}

TEST_F(V4l2CameraTest, WhatTheDriverSkippedIsCounted) {
  webcam_->skipped = {1, 2, 4};
  start();
  std::vector<std::int64_t> indices;
  for (int i = 0; i < 6; ++i) {
    if (const auto frame = step()) indices.push_back(frame->index);
  }
  EXPECT_EQ(indices, (std::vector<std::int64_t>{0, 3, 5}));
  EXPECT_EQ(camera_->counters().dropped, 3);
}

// With four buffers the driver has nowhere to put the rest.
TEST_F(V4l2CameraTest, ALongPauseCostsPicturesAndNothingElse) {
  start();
  ASSERT_TRUE(step());
  clock_.wait_until(clock_.now_ns() + 9 * kPeriodNs);
  EXPECT_TRUE(camera_->take_newest());
  const std::optional<Frame> frame = step();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->index, 10);
  EXPECT_EQ(camera_->counters().dropped + camera_->counters().delivered, 11);
  clock_.wait_until(clock_.now_ns() + 3 * kPeriodNs);  // all four buffers are in use again
  EXPECT_EQ(camera_->take_newest().value().index, 13);
  EXPECT_EQ(camera_->state(), CameraState::Streaming);
  EXPECT_EQ(webcam_->streams, 1);
}

TEST_F(V4l2CameraTest, ACameraThatFillsBuffersFasterThanTheyAreEmptiedIsNoTrap) {
  webcam_->hasty = true;
  start();
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(step());
  EXPECT_EQ(camera_->state(), CameraState::Streaming);
}

TEST_F(V4l2CameraTest, TimesAreTheDriversOrThoseAtWhichPicturesCame) {
  start();
  EXPECT_EQ(step()->timestamp_ns, kPeriodNs);
  clock_.wait_until(clock_.now_ns() + kPeriodNs + kPeriodNs / 2);
  EXPECT_EQ(camera_->take_newest()->timestamp_ns, 2 * kPeriodNs);
  webcam_->monotonic = false;
  EXPECT_EQ(step()->timestamp_ns, 3 * kPeriodNs + kPeriodNs / 2);
}

TEST_F(V4l2CameraTest, AStallIsEndedByANewStream) {
  start();
  ASSERT_TRUE(step());
  webcam_->silence = Silence::UntilBegunAnew;
  pass(0.9);
  EXPECT_EQ(camera_->state(), CameraState::Streaming);
  pass(0.1);
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  const std::optional<Frame> frame = step();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->index, 1);  // goes on, though the driver counts anew
  EXPECT_EQ(camera_->state(), CameraState::Streaming);
  EXPECT_EQ(webcam_->streams, 2);
  EXPECT_EQ(webcam_->opened, 1);
}

TEST_F(V4l2CameraTest, AStallThatGoesOnIsEndedByOpeningAnew) {
  start();
  ASSERT_TRUE(step());
  webcam_->silence = Silence::UntilOpenedAnew;
  // Ten periods each until it is begun anew and closed, a quarter of a second to the opening.
  EXPECT_EQ(periods_until_frame(), 10 + 10 + 3 + 1);
  EXPECT_EQ(webcam_->opened, 2);
  EXPECT_EQ(camera_->state(), CameraState::Streaming);
}

TEST_F(V4l2CameraTest, OnlyDamagedPicturesAreAStall) {
  for (std::uint32_t i = 1; i < 100; ++i) webcam_->faulty.insert(i);
  start();
  ASSERT_TRUE(step());
  pass(1.0);
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  EXPECT_EQ(webcam_->streams, 2);
}

TEST_F(V4l2CameraTest, AnUnpluggedCameraIsLostClosedAndComesBackByItself) {
  start();
  ASSERT_TRUE(step());
  webcam_->unplug();
  EXPECT_FALSE(step());
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  EXPECT_EQ(webcam_->mapped, 0);
  EXPECT_EQ(webcam_->open, 0);
  pass(20.0);
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  webcam_->plug();
  const int periods = periods_until_frame();
  EXPECT_GT(periods, 0);
  EXPECT_LE(periods, 42);  // four seconds at most where nobody tells
  EXPECT_EQ(camera_->state(), CameraState::Streaming);
}

TEST_F(V4l2CameraTest, WhereUdevTellsAPluggedCameraIsThereAtOnce) {
  start();
  ASSERT_TRUE(step());
  webcam_->unplug();
  pass(20.0);
  webcam_->plug();
  video_->announce();
  EXPECT_EQ(periods_until_frame(), 2);  // one to be seen, one for the first picture
}

TEST_F(V4l2CameraTest, ErrorsAndHangUpsEndTheStreamToo) {
  start();
  ASSERT_TRUE(step());
  webcam_->take_error = EIO;
  EXPECT_FALSE(step());
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  EXPECT_GT(periods_until_frame(), 0);
  EXPECT_EQ(webcam_->opened, 2);

  webcam_->silence = Silence::ForGood;
  webcam_->hung_up = true;
  EXPECT_FALSE(step());
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  webcam_->silence = Silence::None;
  EXPECT_GT(periods_until_frame(), 0);
  EXPECT_EQ(webcam_->opened, 3);
}

TEST_F(V4l2CameraTest, ComesBackInTheSameModeUnderAnotherPathAndNoOther) {
  webcam_->modes = {{V4L2_PIX_FMT_MJPEG, 32, 24, {10}}, {V4L2_PIX_FMT_MJPEG, 64, 48, {10}}};
  const auto stranger = std::make_shared<FakeCamera>();
  stranger->path = "/dev/video1";
  stranger->card = "Stranger";
  webcams_ = {webcam_, stranger};
  options_.device = "auto";
  start();
  ASSERT_TRUE(step());
  webcam_->unplug();
  pass(10.0);
  EXPECT_EQ(stranger->streams, 0);  // its lens is another one
  webcam_->path = "/dev/video2";
  webcam_->modes.erase(webcam_->modes.begin());
  webcam_->plug();
  pass(10.0);
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  webcam_->modes.push_back({V4L2_PIX_FMT_MJPEG, 32, 24, {10}});
  EXPECT_GT(periods_until_frame(), 0);
}

TEST_F(V4l2CameraTest, AnotherCameraUnderItsPathIsNotTaken) {
  options_.device = "/dev/video0";
  start();
  ASSERT_TRUE(step());
  webcam_->unplug();
  step();
  webcam_->card = "Stranger";
  webcam_->plug();
  pass(10.0);
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  webcam_->card = "Fake Webcam";
  EXPECT_GT(periods_until_frame(), 0);
}

// Whatever it is doing when the plug is pulled.
TEST_F(V4l2CameraTest, MayBeUnpluggedAtAnyCall) {
  start();
  int survived = 0;
  for (int calls = 0; calls < 60; ++calls) {
    ASSERT_GT(periods_until_frame(), 0) << calls;
    camera_->lock_exposure(calls % 2 == 0);
    webcam_->calls_until_unplugged = calls;
    for (int i = 0; i < 40 && webcam_->plugged; ++i) step();
    ASSERT_FALSE(webcam_->plugged) << calls;
    step();
    EXPECT_EQ(camera_->state(), CameraState::Lost) << calls;
    EXPECT_EQ(webcam_->mapped, 0) << calls;
    EXPECT_EQ(webcam_->open, 0) << calls;
    webcam_->calls_until_unplugged = calls;  // and again while it is being opened
    webcam_->plug();
    video_->announce();
    pass(1.0);
    webcam_->calls_until_unplugged = -1;
    webcam_->plug();
    video_->announce();
    ++survived;
  }
  EXPECT_EQ(survived, 60);
  camera_.reset();
  EXPECT_EQ(webcam_->mapped, 0);
}

TEST_F(V4l2CameraTest, HoldsExposureFromTheNextFrameOnAndAfterItWasLost) {
  start();
  ASSERT_TRUE(step());
  camera_->lock_exposure(true);
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 1);  // setting it here would keep the loop waiting
  step();
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 0);
  const std::size_t writes = webcam_->writes.size();
  pass(1.0);
  EXPECT_EQ(webcam_->writes.size(), writes);  // done once

  webcam_->unplug();
  step();
  webcam_->controls = testing::webcam_controls();
  webcam_->controls[V4L2_CID_FOCUS_ABSOLUTE].value = 99;
  webcam_->plug();
  ASSERT_GT(periods_until_frame(), 0);
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 0);
  EXPECT_EQ(value(V4L2_CID_FOCUS_ABSOLUTE), 40);

  camera_->lock_exposure(false);
  step();
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 1);
}

// What is set in a webcam stays there until its power goes: the next program would find it so.
TEST_F(V4l2CameraTest, LeavesTheCameraAsItFoundIt) {
  start();
  ASSERT_TRUE(step());
  camera_->lock_exposure(true);
  step();
  ASSERT_EQ(value(V4L2_CID_FOCUS_AUTO), 0);
  camera_->stop();
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 1);
  camera_->start();
  ASSERT_TRUE(step());
  step();
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 0) << "still wanted";
  camera_.reset();
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 1);
}

TEST_F(V4l2CameraTest, WhatACrashLeftHeldIsAutomaticAgainBeforeTheFirstPicture) {
  webcam_->controls[V4L2_CID_EXPOSURE_AUTO].value = V4L2_EXPOSURE_MANUAL;
  webcam_->controls[V4L2_CID_AUTO_WHITE_BALANCE].value = 0;
  start();
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_APERTURE_PRIORITY);
  EXPECT_EQ(value(V4L2_CID_AUTO_WHITE_BALANCE), 1);
  ASSERT_TRUE(step());
  camera_->lock_exposure(true);
  step();
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
  camera_.reset();
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_APERTURE_PRIORITY);
}

TEST_F(V4l2CameraTest, AStreamThatIsBegunAnewIsAsAutomaticAsTheFirst) {
  start();
  ASSERT_TRUE(step());
  // As one that lost its power may come back.
  webcam_->controls[V4L2_CID_AUTO_WHITE_BALANCE].value = 0;
  webcam_->silence = testing::Silence::UntilBegunAnew;
  EXPECT_GT(periods_until_frame(), 1);
  EXPECT_EQ(value(V4L2_CID_AUTO_WHITE_BALANCE), 1);
}

TEST_F(V4l2CameraTest, AnExposureFreedWhileTheCameraIsGoneIsFreedWhenItIsBack) {
  start();
  ASSERT_TRUE(step());
  camera_->lock_exposure(true);
  step();
  webcam_->unplug();
  step();
  camera_->lock_exposure(false);
  webcam_->plug();
  ASSERT_GT(periods_until_frame(), 0);
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 1);
}

TEST_F(V4l2CameraTest, ThePowerLineIsSetIfAskedFor) {
  start();
  EXPECT_EQ(value(V4L2_CID_POWER_LINE_FREQUENCY), 2);
  options_.wishes.power_line = "50hz";
  start();
  EXPECT_EQ(value(V4L2_CID_POWER_LINE_FREQUENCY), 1);
}

TEST_F(V4l2CameraTest, StartingAnewFindsACameraThatWasPluggedInAgainMeanwhile) {
  start();
  ASSERT_TRUE(step());
  camera_->stop();
  webcam_->unplug();
  EXPECT_THAT(testing::message_of([&] { camera_->start(); }), HasSubstr("no camera found"));
  webcam_->plug();
  camera_->start();
  EXPECT_EQ(step()->index, 0);
}

TEST(LinuxVideo, WhatIsNoCameraIsSaidToBeNone) {
  const SystemClock clock;
  CameraOptions options;
  options.device = "/dev/null";
  EXPECT_THAT(testing::message_of([&] { V4l2Camera(options, clock); }),
              HasSubstr("/dev/null: no camera that streams"));
  options.device = "/nowhere/video";
  EXPECT_THAT(testing::message_of([&] { V4l2Camera(options, clock); }),
              HasSubstr("/nowhere/video: No such file"));
}

/// Time that a test sets while another thread reads it.
class SharedClock : public Clock {
 public:
  std::int64_t now_ns() const override { return now_ns_; }
  void wait_until(std::int64_t deadline_ns) override { now_ns_ = deadline_ns; }

 private:
  std::atomic<std::int64_t> now_ns_ = 0;
};

TEST(V4l2Thread, GivesWhatTheCameraGivesUntilItIsStopped) {
  SharedClock clock;
  const auto webcam = std::make_shared<FakeCamera>();
  auto fake = std::make_unique<FakeVideo>(clock, std::vector<std::shared_ptr<FakeCamera>>{webcam});
  FakeVideo* video = fake.get();
  V4l2Camera camera({}, clock, std::move(fake));
  camera.start();
  for (int i = 0; i < 20; ++i) {
    clock.wait_until(clock.now_ns() + kPeriodNs);
    video->wake();
    std::optional<Frame> frame;
    while (!(frame = camera.take_newest())) std::this_thread::yield();
    EXPECT_EQ(frame->index, i);
  }
  camera.lock_exposure(true);
  camera.stop();
  EXPECT_EQ(camera.state(), CameraState::Stopped);
  EXPECT_EQ(camera.counters().delivered, 20);
  EXPECT_EQ(camera.counters().dropped, 0);
  EXPECT_EQ(webcam->mapped, 0);
}

// A damaged JPEG is counted when it is decoded: here before the loop asks for it.
TEST(V4l2Thread, DecodesBesideTheLoop) {
  SharedClock clock;
  const auto webcam = std::make_shared<FakeCamera>();
  webcam->garbled = {0};
  auto fake = std::make_unique<FakeVideo>(clock, std::vector<std::shared_ptr<FakeCamera>>{webcam});
  FakeVideo* video = fake.get();
  V4l2Camera camera({}, clock, std::move(fake));
  camera.start();
  clock.wait_until(kPeriodNs);
  video->wake();
  while (camera.counters().dropped == 0) std::this_thread::yield();
  EXPECT_FALSE(camera.take_newest());
}

TEST(V4l2Thread, SeesThatTheCameraIsGoneAndBack) {
  SharedClock clock;
  const auto webcam = std::make_shared<FakeCamera>();
  auto fake = std::make_unique<FakeVideo>(clock, std::vector<std::shared_ptr<FakeCamera>>{webcam});
  FakeVideo* video = fake.get();
  webcam->calls_until_unplugged = 60;  // some frames later
  V4l2Camera camera({}, clock, std::move(fake));
  camera.start();
  while (camera.state() != CameraState::Lost) {
    clock.wait_until(clock.now_ns() + kPeriodNs / 100);
    video->wake();
    camera.take_newest();
    std::this_thread::yield();
  }
  camera.stop();
  webcam->plug();
  webcam->calls_until_unplugged = -1;
  camera.start();
  EXPECT_EQ(camera.state(), CameraState::Streaming);
}

}  // namespace
}  // namespace lumibox::hal
