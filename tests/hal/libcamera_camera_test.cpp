// The libcamera backend with cameras in memory, which are unplugged, stall and lie. What is common
// to all real cameras (live::Streamer) is tested with webcams in v4l2_camera_test.cpp, too.

#include "hal/libcamera/libcamera_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "config/error.h"
#include "hal/fake_libcamera.h"
#include "hal/sim/virtual_clock.h"
#include "support/input_error.h"

namespace lumibox::hal {
namespace {

using ::testing::AllOf;
using testing::FakeLibcamera;
using testing::FakeSensor;
using ::testing::HasSubstr;
using testing::offer;
using testing::Silence;

constexpr std::int64_t kPeriodNs = 100'000'000;

class LibcameraCameraTest : public ::testing::Test {
 protected:
  LibcameraCameraTest() {
    options_.wishes.stall_periods = 10;
    options_.wishes.rate_hz = 10;
    options_.wishes.width = 32;
    options_.wishes.height = 24;
  }

  LibcameraCamera& open() {
    camera_.reset();
    auto system = std::make_unique<FakeLibcamera>(clock_, sensors_);
    system_ = system.get();
    camera_ =
        std::make_unique<LibcameraCamera>(options_, clock_, std::move(system), Service::Caller);
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

  void pass(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 10); ++i) step();
  }

  VirtualClock clock_;
  std::shared_ptr<FakeSensor> sensor_ = std::make_shared<FakeSensor>();
  std::vector<std::shared_ptr<FakeSensor>> sensors_ = {sensor_};
  CameraOptions options_;
  FakeLibcamera* system_ = nullptr;
  std::unique_ptr<LibcameraCamera> camera_;
};

TEST_F(LibcameraCameraTest, IsFoundByNumberIdPartOfItsNamesOrFirst) {
  const auto other = std::make_shared<FakeSensor>();
  other->id = "/base/i2c@2/other@10";
  other->model = "Other 708";
  sensors_ = {sensor_, other};
  for (const char* name : {"auto", "0", "/base/i2c@1/fake@1a", "FAKE", "i2c@1"}) {
    sensor_->streams = other->streams = 0;
    options_.device = name;
    start();
    EXPECT_EQ(sensor_->streams, 1) << name;
  }
  for (const char* name : {"1", "other 708", "/base/i2c@2/other@10", "i2c@2"}) {
    sensor_->streams = other->streams = 0;
    options_.device = name;
    start();
    EXPECT_EQ(other->streams, 1) << name;
  }
}

TEST_F(LibcameraCameraTest, CamerasThatCannotBeUsedAreNamedWithTheReason) {
  options_.device = "2";
  EXPECT_THAT(complaint(), AllOf(HasSubstr("devices.camera: libcamera finds no camera \"2\""),
                                 HasSubstr("it has 0: fake (/base/i2c@1/fake@1a)")));
  options_.device = "auto";
  sensor_->open_error = EBUSY;
  EXPECT_THAT(complaint(), AllOf(HasSubstr("fake (/base"), HasSubstr("another program")));
  sensor_->open_error = EACCES;
  EXPECT_THAT(complaint(), HasSubstr("group video"));
  sensor_->open_error = 0;
  sensor_->offers.clear();
  EXPECT_THAT(complaint(), HasSubstr("no format that can be read here"));
  sensors_.clear();
  EXPECT_THAT(complaint(), HasSubstr("libcamera finds no camera"));
}

TEST_F(LibcameraCameraTest, WhatAPlugMendsMayBeWaitedForAndWrongWishesMayNot) {
  sensor_->start_error = EBUSY;
  open();
  EXPECT_THROW(camera_->start(), config::Unavailable);
  sensor_->unplug();
  EXPECT_THROW(open(), config::Unavailable);
  options_.calibration = config::CameraProfile();
  options_.calibration->width = 64;
  try {
    open();
    ADD_FAILURE() << "32 is not 64";
  } catch (const config::Unavailable& fault) {
    ADD_FAILURE() << fault.what();
  } catch (const config::InputError& fault) {
    EXPECT_THAT(fault.what(), HasSubstr("expected that, or 0"));
  }
}

TEST_F(LibcameraCameraTest, IsIntroducedOnceAndNotBeforeItStreams) {
  options_.wishes.power_line = "50hz";
  sensor_->start_error = EBUSY;
  ::testing::internal::CaptureStdout();
  open();
  EXPECT_THROW(camera_->start(), config::Unavailable);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  sensor_->start_error = 0;
  ::testing::internal::CaptureStdout();
  camera_->start();
  camera_->start();
  const std::string said = ::testing::internal::GetCapturedStdout();
  for (const char* words : {"chosen: nv12 32x24", "no calibration", "camera.power_line"}) {
    EXPECT_THAT(said, HasSubstr(words));
    EXPECT_EQ(said.find(words), said.rfind(words)) << "once";
  }
}

TEST_F(LibcameraCameraTest, SizesThatCannotBeReadAreLeftOut) {
  sensor_->offers = {offer(live::PixelFormat::Nv12, 1U << 30, 1U << 30),
                     offer(live::PixelFormat::Nv12, 640, 0xFFFFFFFF),
                     offer(live::PixelFormat::Nv12, 31, 24)};
  EXPECT_THAT(complaint(), HasSubstr("no format that can be read here"));
}

TEST_F(LibcameraCameraTest, OnlyTheCalibrationsSizeWillDo) {
  config::CameraProfile profile;
  profile.width = 64;
  profile.height = 48;
  options_.calibration = profile;
  options_.wishes.width = options_.wishes.height = 0;
  EXPECT_THAT(complaint(), AllOf(HasSubstr("no pictures of 64x48"), HasSubstr("it has 32x24")));
  sensor_->offers = {{live::PixelFormat::Nv12, {16, 16}, {640, 480}, {1, 1}}};
  open();
  EXPECT_EQ(camera_->profile().width, 64);
}

TEST_F(LibcameraCameraTest, OfARangeTheNearestSizeThatCanBeReadIsTaken) {
  sensor_->offers = {{live::PixelFormat::Yuv420, {15, 15}, {63, 63}, {1, 1}}};
  options_.wishes.width = 41;
  options_.wishes.height = 480;
  open();
  EXPECT_EQ(camera_->profile().width, 42);
  EXPECT_EQ(camera_->profile().height, 62);
}

TEST_F(LibcameraCameraTest, WhatTheCameraMakesOfTheModeIsTakenIfItWillDo) {
  sensor_->gives = libcam::Configured{live::PixelFormat::Yuyv, 48, 24, 0, false};
  start();
  EXPECT_EQ(camera_->profile().width, 48);
  EXPECT_EQ(step().value().color->width(), 48);
  sensor_->unplug();
  step();
  sensor_->plugged = true;
  EXPECT_GT(periods_until_frame(), 0);  // and asked for just that from then on

  options_.wishes.format = "nv12";
  EXPECT_THAT(complaint(), HasSubstr("was asked for nv12 32x24 and gives 48x24 in yuyv"));
  options_.wishes.format = "auto";
  sensor_->gives = libcam::Configured{std::nullopt, 32, 24, 0, false};
  EXPECT_THAT(complaint(), HasSubstr("in a format that is not read here"));
  sensor_->gives = libcam::Configured{live::PixelFormat::Nv12, 33, 24, 0, false};
  EXPECT_THAT(complaint(), HasSubstr("gives 33x24"));
  config::CameraProfile profile;
  profile.width = 32;
  profile.height = 24;
  options_.calibration = profile;
  sensor_->gives = libcam::Configured{live::PixelFormat::Nv12, 48, 24, 0, false};
  EXPECT_THAT(complaint(), HasSubstr("gives 48x24"));
}

TEST_F(LibcameraCameraTest, ComesBackInTheSameModeAndNoOther) {
  start();
  ASSERT_TRUE(step());
  sensor_->unplug();
  step();
  sensor_->plugged = true;
  sensor_->gives = libcam::Configured{live::PixelFormat::Nv12, 48, 24, 0, false};
  pass(10.0);
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  sensor_->gives.reset();
  EXPECT_GT(periods_until_frame(), 0);
}

TEST_F(LibcameraCameraTest, IsToldTheRateAsFarAsItCanKeepToIt) {
  start();
  EXPECT_EQ(camera_->profile().fps, 10.0);
  EXPECT_EQ(sensor_->orders.front().frame_duration_us, 100'000);
  EXPECT_EQ(sensor_->orders.front().automatic, true);
  options_.wishes.rate_hz = 200;
  open();
  EXPECT_EQ(camera_->profile().fps, 100.0);  // its shortest duration
  options_.wishes.rate_hz = 5;
  open();
  EXPECT_EQ(camera_->profile().fps, 10.0);  // its longest
  using Range = std::pair<std::int64_t, std::int64_t>;
  for (const std::optional<Range>& none : {std::optional<Range>(), std::optional(Range(0, 0))}) {
    sensor_->abilities.frame_duration_us = none;
    sensor_->orders.clear();
    start();
    EXPECT_EQ(camera_->profile().fps, 5.0);
    EXPECT_FALSE(sensor_->orders.front().frame_duration_us);
  }
}

TEST_F(LibcameraCameraTest, ARefusalToStreamIsSaid) {
  sensor_->start_error = EIO;
  open();
  EXPECT_THAT(testing::message_of([&] { camera_->start(); }),
              AllOf(HasSubstr("fake (/base"), HasSubstr("does not stream: Input/output error")));
  EXPECT_EQ(camera_->state(), CameraState::Stopped);
  sensor_->start_error = 0;
  camera_->start();
  EXPECT_EQ(periods_until_frame(), 1);
}

TEST_F(LibcameraCameraTest, DamagedAndCancelledPicturesAreLeftOutAndCounted) {
  sensor_->faulty = {1};
  sensor_->cancelled = {3};
  sensor_->cut = {5};
  start();
  std::vector<std::int64_t> indices;
  for (int i = 0; i < 8; ++i) {
    if (const auto frame = step()) indices.push_back(frame->index);
  }
  EXPECT_EQ(indices, (std::vector<std::int64_t>{0, 2, 4, 6, 7}));
  EXPECT_EQ(camera_->counters().dropped, 3);
  EXPECT_EQ(camera_->state(), CameraState::Streaming);
}

TEST_F(LibcameraCameraTest, ALongPauseCostsPicturesAndNothingElse) {
  start();
  ASSERT_TRUE(step());
  clock_.wait_until(clock_.now_ns() + 9 * kPeriodNs);
  EXPECT_TRUE(camera_->take_newest());
  EXPECT_EQ(step().value().index, 10);
  EXPECT_EQ(camera_->counters().dropped + camera_->counters().delivered, 11);
  EXPECT_EQ(sensor_->streams, 1);
}

// However the planes lie in memory, and whatever is between them.
TEST_F(LibcameraCameraTest, ThePictureIsTheSameHoweverItsPlanesLie) {
  for (const live::PixelFormat format : {live::PixelFormat::Nv12, live::PixelFormat::Yuv420,
                                         live::PixelFormat::Yuyv, live::PixelFormat::Bgrx}) {
    *sensor_ = FakeSensor();
    sensor_->offers = {offer(format, 32, 24)};
    start();
    const Image plain = *step().value().color;
    sensor_->spare = 96;
    sensor_->padding = 16;
    start();
    EXPECT_EQ(*step().value().color, plain) << live::name_of(format);
    sensor_->spare = 0;
    sensor_->in_one_piece = true;
    start();
    EXPECT_EQ(*step().value().color, plain) << live::name_of(format);
  }
}

TEST_F(LibcameraCameraTest, AJpegIsAsLongAsTheCameraSays) {
  sensor_->offers = {offer(live::PixelFormat::Mjpeg, 32, 24)};
  start();
  EXPECT_TRUE(step());
  sensor_->cut = {1};
  EXPECT_FALSE(step());
}

TEST_F(LibcameraCameraTest, TimesAreOfTheExposureOfTheMiddleRow) {
  config::CameraProfile profile;
  profile.width = 32;
  profile.height = 24;
  profile.readout_s = 0.02;
  options_.calibration = profile;
  start();
  EXPECT_EQ(step().value().timestamp_ns, kPeriodNs + 10'000'000);
  sensor_->says_exposure_begin = false;  // what is said then is of the picture's end
  EXPECT_EQ(step().value().timestamp_ns, 2 * kPeriodNs - 10'000'000);
}

TEST_F(LibcameraCameraTest, AStallIsEndedByANewStreamOrByOpeningAnew) {
  start();
  ASSERT_TRUE(step());
  sensor_->silence = Silence::UntilBegunAnew;
  EXPECT_EQ(periods_until_frame(), 10 + 1);
  EXPECT_EQ(sensor_->streams, 2);
  EXPECT_EQ(sensor_->opened, 1);
  sensor_->silence = Silence::UntilOpenedAnew;
  EXPECT_EQ(periods_until_frame(), 10 + 10 + 3 + 1);
  EXPECT_EQ(sensor_->opened, 2);
  EXPECT_EQ(camera_->state(), CameraState::Streaming);
}

TEST_F(LibcameraCameraTest, ARemovedCameraIsLostReleasedAndComesBackWhenItIsAdded) {
  start();
  ASSERT_TRUE(step());
  sensor_->unplug();
  EXPECT_FALSE(step());
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  EXPECT_EQ(sensor_->open, 0);
  pass(20.0);
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  sensor_->plugged = true;
  system_->announce();
  EXPECT_EQ(periods_until_frame(), 2);  // one to be seen, one for the first picture
  EXPECT_EQ(camera_->state(), CameraState::Streaming);
}

TEST_F(LibcameraCameraTest, ARemovedCameraThatGivesNoRequestBackIsLostToo) {
  sensor_->cancels = false;
  start();
  ASSERT_TRUE(step());
  sensor_->unplug();
  step();
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  EXPECT_EQ(sensor_->open, 0);
}

TEST_F(LibcameraCameraTest, ARequestThatIsRefusedEndsTheStream) {
  start();
  ASSERT_TRUE(step());
  sensor_->queue_error = EIO;
  step();
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  EXPECT_EQ(sensor_->open, 0);
  EXPECT_GT(periods_until_frame(), 0);
  EXPECT_EQ(sensor_->opened, 2);
}

TEST_F(LibcameraCameraTest, NoOtherCameraIsTakenForOneThatIsGone) {
  const auto stranger = std::make_shared<FakeSensor>();
  stranger->id = "/base/i2c@2/stranger@10";
  sensors_ = {sensor_, stranger};
  start();
  ASSERT_TRUE(step());
  sensor_->unplug();
  pass(10.0);
  EXPECT_EQ(camera_->state(), CameraState::Lost);
  EXPECT_EQ(stranger->streams, 0);
}

// Whatever it is doing when it goes.
TEST_F(LibcameraCameraTest, MayBeRemovedAtAnyCall) {
  start();
  for (int calls = 0; calls < 30; ++calls) {
    ASSERT_GT(periods_until_frame(), 0) << calls;
    camera_->lock_exposure(calls % 2 == 0);
    sensor_->calls_until_unplugged = calls;
    for (int i = 0; i < 40 && sensor_->plugged; ++i) step();
    ASSERT_FALSE(sensor_->plugged) << calls;
    step();
    EXPECT_EQ(camera_->state(), CameraState::Lost) << calls;
    EXPECT_EQ(sensor_->open, 0) << calls;
    sensor_->calls_until_unplugged = calls;  // and again while it is being opened
    sensor_->plugged = true;
    system_->announce();
    pass(1.0);
    sensor_->calls_until_unplugged = -1;
    sensor_->plugged = true;
    system_->announce();
  }
  camera_.reset();
  EXPECT_EQ(sensor_->open, 0);
}

TEST_F(LibcameraCameraTest, HoldsWhatTheCameraDoesNowAndAfterItWasLost) {
  start();
  ASSERT_TRUE(step());
  camera_->lock_exposure(true);
  pass(1.0);
  sensor_->own = {20'000, 4.0F, {{1.0F, 1.0F}}, 3.0F};  // the light has changed
  pass(0.5);
  EXPECT_EQ(sensor_->now.exposure_us, 10'000);
  EXPECT_EQ(sensor_->now.gain, 2.0F);
  EXPECT_EQ(sensor_->now.lens_dioptres, 1.0F);
  const std::size_t told = sensor_->orders.size();
  pass(5.0);
  EXPECT_EQ(sensor_->orders.size(), told);  // once it is so

  sensor_->unplug();
  step();
  sensor_->plugged = true;
  ASSERT_GT(periods_until_frame(), 0);
  EXPECT_EQ(sensor_->now.exposure_us, 10'000);  // from the first picture on

  camera_->lock_exposure(false);
  pass(1.0);
  EXPECT_EQ(sensor_->now.exposure_us, 20'000);
  EXPECT_EQ(sensor_->orders.back().frame_duration_us, 100'000);  // kept to, whatever is told
}

TEST_F(LibcameraCameraTest, WhatIsHeldEndsWithTheStream) {
  start();
  ASSERT_TRUE(step());
  camera_->lock_exposure(true);
  pass(1.0);
  camera_->stop();
  sensor_->own.exposure_us = 20'000;
  camera_->start();
  EXPECT_EQ(sensor_->orders.back().automatic, true);
  ASSERT_TRUE(step());
  pass(1.0);
  EXPECT_EQ(sensor_->orders.back().values.exposure_us, 20'000) << "still wanted";
}

TEST_F(LibcameraCameraTest, IsListedWithWhatItOffers) {
  sensor_->offers = {offer(live::PixelFormat::Nv12, 640, 480),
                     {live::PixelFormat::Bgrx, {64, 64}, {1920, 1080}, {2, 2}}};
  const auto busy = std::make_shared<FakeSensor>();
  busy->id = busy->model = "usb-1";
  busy->open_error = EBUSY;
  FakeLibcamera system(clock_, {sensor_, busy});
  EXPECT_EQ(list_cameras(system),
            "libcamera:0: fake (/base/i2c@1/fake@1a)\n"
            "  nv12 640x480\n"
            "  bgrx 64x64 to 1920x1080\n"
            "  can be held: focus, exposure, white balance\n"
            "  10 to 100 Hz\n"
            "libcamera:1: usb-1\n"
            "  cannot be opened: Device or resource busy; is another program using it?\n");
  FakeLibcamera nothing(clock_, {});
  EXPECT_EQ(list_cameras(nothing), "");
}

/// Time that a test sets while another thread reads it.
class SharedClock : public Clock {
 public:
  std::int64_t now_ns() const override { return now_ns_; }
  void wait_until(std::int64_t deadline_ns) override { now_ns_ = deadline_ns; }

 private:
  std::atomic<std::int64_t> now_ns_ = 0;
};

TEST(LibcameraThread, GivesWhatTheCameraGivesUntilItIsStopped) {
  SharedClock clock;
  const auto sensor = std::make_shared<FakeSensor>();
  auto fake =
      std::make_unique<FakeLibcamera>(clock, std::vector<std::shared_ptr<FakeSensor>>{sensor});
  FakeLibcamera* system = fake.get();
  CameraOptions options;
  options.wishes.rate_hz = 10;
  LibcameraCamera camera(options, clock, std::move(fake));
  camera.start();
  for (int i = 0; i < 20; ++i) {
    clock.wait_until(clock.now_ns() + kPeriodNs);
    system->wake();
    std::optional<Frame> frame;
    while (!(frame = camera.take_newest())) std::this_thread::yield();
    EXPECT_EQ(frame->index, i);
  }
  camera.lock_exposure(true);
  camera.stop();
  EXPECT_EQ(camera.state(), CameraState::Stopped);
  EXPECT_EQ(camera.counters().delivered, 20);
  EXPECT_EQ(camera.counters().dropped, 0);
}

// This machine may have cameras, but none of this name.
TEST(RealCameraSystem, CanBeMadeAnewAndOpensNoCameraThatIsNot) {
  for (int i = 0; i < 2; ++i) {
    const auto system = libcam::real_camera_system();
    EXPECT_EQ(system->open("no such camera").error, ENODEV);
    EXPECT_GE(system->watch_fd(), 0);
    system->changed();
    EXPECT_FALSE(system->changed());
  }
}

}  // namespace
}  // namespace lumibox::hal
