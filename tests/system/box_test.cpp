// The whole box on a virtual clock: a simulated camera is walked past some blocks, buttons are
// pressed by a script, and what ends up on disk and on the screen is looked at.

#include <gtest/gtest.h>
#include <sys/mount.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/button_script.h"
#include "app/loop.h"
#include "config/error.h"
#include "hal/offscreen/offscreen_display.h"
#include "hal/scripted/scripted_buttons.h"
#include "hal/sim/sim_camera.h"
#include "hal/sim/virtual_clock.h"
#include "lightfield/capture.h"
#include "support/source_file.h"
#include "support/temp_dir.h"

namespace lumibox::app {
namespace {

using hal::Button;
using testing::TempDir;

const std::filesystem::path kScene =
    std::filesystem::path(LUMIBOX_SOURCE_DIR) / "tests/system/corner_of_a_desk.toml";

struct TimedPress {
  double time_s;
  Gesture gesture;
};

/// A camera that fails once time has come, as a replay does at a damaged picture.
class FailingCamera : public hal::Camera {
 public:
  FailingCamera(std::unique_ptr<hal::Camera> camera, const hal::Clock& clock, double fails_at_s)
      : camera_(std::move(camera)), clock_(clock), fails_at_s_(fails_at_s) {}

  const config::CameraProfile& profile() const override { return camera_->profile(); }
  void start() override { camera_->start(); }
  void stop() override { camera_->stop(); }
  hal::CameraState state() const override { return camera_->state(); }
  hal::CameraCounters counters() const override { return camera_->counters(); }
  void lock_exposure(bool locked) override { camera_->lock_exposure(locked); }
  std::optional<hal::Frame> take_newest() override {
    if (1e-9 * static_cast<double>(clock_.now_ns()) >= fails_at_s_) {
      throw config::InputError("a damaged picture");
    }
    return camera_->take_newest();
  }

 private:
  std::unique_ptr<hal::Camera> camera_;
  const hal::Clock& clock_;
  double fails_at_s_;
};

/// One box and its run; captures go into `captures`.
class BoxRun {
 public:
  BoxRun(const std::vector<TimedPress>& presses, const std::filesystem::path& captures,
         double camera_fails_at_s = 1e9) {
    config_.loop.rate_hz = 15.0;
    config_.capture.threshold_deg = 3.0;
    devices_.clock = std::make_unique<hal::VirtualClock>();
    devices_.camera = std::make_unique<FailingCamera>(
        std::make_unique<hal::SimCamera>(hal::load_scene(kScene), *devices_.clock), *devices_.clock,
        camera_fails_at_s);
    std::vector<hal::ButtonEvent> events;
    for (const TimedPress& press : presses) {
      for (const auto& event :
           press_at(press.time_s, press.gesture, config_.controls.long_press_s)) {
        events.push_back(event);
      }
    }
    devices_.buttons = std::make_unique<hal::ScriptedButtons>(events, *devices_.clock);
    auto display = std::make_unique<hal::OffscreenDisplay>(160, 120);
    screen_ = display.get();
    devices_.display = std::move(display);
    devices_.display->make_current();
    devices_.camera->start();
    loop_ = std::make_unique<Loop>(devices_, config_, captures, kLockstep);
  }

  void until(double time_s) {
    loop_->run([&] { return 1e-9 * static_cast<double>(devices_.clock->now_ns()) < time_s; });
  }

  Loop& loop() { return *loop_; }
  hal::Image screen() const { return screen_->read_back(); }
  std::size_t views() const { return loop_->recorder().light_field().perspectives().size(); }

 private:
  config::Config config_;
  Devices devices_;
  const hal::OffscreenDisplay* screen_ = nullptr;
  std::unique_ptr<Loop> loop_;
};

/// Path within the folder and content of every file.
std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[std::filesystem::relative(entry.path(), folder)] = testing::read_text(entry.path());
    }
  }
  return files;
}

double mean_brightness(const hal::Image& image) {
  double sum = 0.0;
  for (std::size_t i = 0; i < image.size_bytes(); ++i) {
    sum += image.data()[i];
  }
  return sum / static_cast<double>(image.size_bytes());
}

const std::vector<TimedPress> kCapture = {
    {0.0, {Button::Main, Press::Short}},  // too early: nothing happens
    {2.0, {Button::Main, Press::Short}},
    {2.3, {Button::Main, Press::Short}},
    {6.4, {Button::Review, Press::Short}},
};

TEST(Box, AWalkAroundASubjectBecomesALightFieldOnTheScreen) {
  const TempDir dir;
  BoxRun run(kCapture, dir.path());
  run.until(1.9);
  EXPECT_EQ(run.loop().mode(), ModeId::Subject) << run.loop().picture().advice;
  run.until(6.3);
  EXPECT_EQ(run.loop().mode(), ModeId::Capture);
  const hal::Image live = run.screen();
  run.until(6.8);
  EXPECT_EQ(run.loop().mode(), ModeId::Review);
  EXPECT_GE(run.views(), 8U);
  EXPECT_GT(mean_brightness(run.screen()), 0.5 * mean_brightness(live));

  run.loop().finish();
  const auto capture = lightfield::load_capture(dir / "capture-0001");
  EXPECT_EQ(capture.light_field.perspectives().size(), run.views());
  EXPECT_FALSE(capture.points.empty());
}

TEST(Box, TwoRunsLeaveTheSameBytes) {
  std::map<std::string, std::string> first;
  for (int i = 0; i < 2; ++i) {
    const TempDir dir;
    BoxRun run(kCapture, dir.path());
    run.until(4.5);
    run.loop().finish();
    const auto files = contents(dir.path());
    ASSERT_GT(files.size(), 3U);
    if (i == 0) {
      first = files;
    } else {
      EXPECT_TRUE(files == first);
    }
  }
}

TEST(Box, WhatIsRecordedBeforeTheCameraFailsIsFinished) {
  const TempDir dir;
  BoxRun run(kCapture, dir.path(), 4.5);
  EXPECT_THROW(run.loop().run_and_finish([] { return true; }), config::InputError);
  const auto capture = lightfield::load_capture(dir / "capture-0001");
  EXPECT_EQ(capture.light_field.perspectives().size(), run.views());
  EXPECT_FALSE(capture.points.empty());
}

/// A file system with little room, while the object lives.
class SmallDisk {
 public:
  explicit SmallDisk(const char* size)
      : mounted_(mount("tmpfs", dir_.path().c_str(), "tmpfs", 0, size) == 0) {}
  ~SmallDisk() {
    if (mounted_) {
      umount2(dir_.path().c_str(), MNT_DETACH);
    }
  }
  bool mounted() const { return mounted_; }
  const std::filesystem::path& path() const { return dir_.path(); }

 private:
  TempDir dir_;
  bool mounted_;
};

TEST(Box, FullDiskIsSaidOnTheScreenAndWhatIsCompleteStaysLoadable) {
  const SmallDisk disk("size=150k");
  if (!disk.mounted()) {
    GTEST_SKIP() << "mounting a small file system needs root";
  }
  BoxRun run(kCapture, disk.path());
  run.until(6.3);
  EXPECT_EQ(run.loop().mode(), ModeId::Capture);
  ASSERT_EQ(run.loop().picture().alerts.size(), 1U);
  EXPECT_NE(run.loop().picture().alerts[0].find(disk.path().string()), std::string::npos);
  const auto capture = lightfield::load_capture(disk.path() / "capture-0001");
  EXPECT_GE(capture.light_field.perspectives().size(), 1U);
  EXPECT_LT(capture.light_field.perspectives().size(), run.views()) << "recording went on";
  EXPECT_THROW(run.loop().finish(), config::InputError);
}

}  // namespace
}  // namespace lumibox::app
