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
#include "app/saved_capture.h"
#include "bench/trajectory.h"
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
         double camera_fails_at_s = 1e9, const std::filesystem::path& scene = kScene) {
    config_.loop.rate_hz = 15.0;
    config_.capture.threshold_deg = 3.0;
    devices_.clock = std::make_unique<hal::VirtualClock>();
    devices_.camera = std::make_unique<FailingCamera>(
        std::make_unique<hal::SimCamera>(hal::load_scene(scene), *devices_.clock), *devices_.clock,
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
    const geometry::Camera camera(devices_.camera->profile());
    loop_ = std::make_unique<Loop>(
        devices_, config_, captures, kLockstep,
        find_saved_capture(captures, camera, config_.tracking.pyramid_levels));
  }

  void until(double time_s) {
    loop_->run([&] { return 1e-9 * static_cast<double>(devices_.clock->now_ns()) < time_s; });
  }

  Loop& loop() { return *loop_; }
  Devices& devices() { return devices_; }
  hal::OffscreenDisplay& display() { return *screen_; }
  hal::Image screen() const { return screen_->read_back(); }
  std::size_t views() const { return loop_->recorder().light_field().perspectives().size(); }

 private:
  config::Config config_;
  Devices devices_;
  hal::OffscreenDisplay* screen_ = nullptr;
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
  EXPECT_NE(run.loop().picture().details.find("likeness"), std::string::npos);
  for (const auto& dot : run.loop().picture().coverage.value().recorded) {
    EXPECT_FALSE(dot.disagrees);
  }
  run.until(6.8);
  EXPECT_EQ(run.loop().mode(), ModeId::Review);
  EXPECT_GE(run.views(), 8U);
  EXPECT_GT(mean_brightness(run.screen()), 0.5 * mean_brightness(live));
  for (const auto& perspective : run.loop().recorder().light_field().perspectives()) {
    EXPECT_EQ(perspective.photo->bytes_held(), 0U) << "they are on disk: " << perspective.id;
  }

  run.loop().finish();
  const auto capture = lightfield::load_capture(dir / "capture-0001");
  EXPECT_EQ(capture.light_field.perspectives().size(), run.views());
  EXPECT_FALSE(capture.points.empty());
}

/// A lamp that counts how often it goes dark.
class CountingLamp : public hal::StatusLed {
 public:
  explicit CountingLamp(std::size_t& blinks) : blinks_(blinks) {}
  void light(bool lit) override {
    blinks_ += is_lit_ && !lit ? 1 : 0;
    is_lit_ = lit;
  }

 private:
  std::size_t& blinks_;
  bool is_lit_ = false;
};

TEST(Box, TheLampBlinksForEachPicture) {
  const TempDir dir;
  BoxRun run(kCapture, dir.path());
  std::size_t blinks = 0;
  run.devices().status_led = std::make_unique<CountingLamp>(blinks);
  run.until(1.9);
  EXPECT_EQ(blinks, 0U);
  run.until(4.5);
  EXPECT_GT(run.views(), 2U);
  EXPECT_EQ(blinks, run.views() - 1);  // when the first is taken it has not been lit yet
}

class StuckButtons : public hal::Buttons {
 public:
  std::vector<hal::ButtonEvent> poll() override { return {}; }
  std::optional<std::string> error() const override { return "stuck: wipe"; }
};

TEST(Box, WhatIsWrongWithAButtonIsOnTheScreen) {
  const TempDir dir;
  BoxRun run({}, dir.path());
  run.until(0.1);
  EXPECT_TRUE(run.loop().picture().alerts.empty());
  run.devices().buttons = std::make_unique<StuckButtons>();
  run.until(0.2);
  EXPECT_EQ(run.loop().picture().alerts, std::vector<std::string>{"buttons: stuck: wipe"});
}

TEST(Box, TheWideApertureFocusesOnWhatIsUnderTheReticle) {
  const TempDir dir;
  std::vector<TimedPress> presses = kCapture;
  presses.push_back({6.9, {Button::Main, Press::Short}});
  BoxRun run(presses, dir.path());
  run.until(6.8);
  EXPECT_FALSE(run.loop().picture().reticle);
  run.until(7.2);
  const Picture& picture = run.loop().picture();
  EXPECT_TRUE(picture.reticle);
  ASSERT_TRUE(picture.light_field);
  EXPECT_EQ(picture.light_field->settings.aperture, render::Aperture::Wide);
  const Eigen::Vector3d& focus = picture.light_field->settings.focus;
  EXPECT_GT((focus - run.loop().recorder().light_field().subject()->center).norm(), 1e-6);
  double nearest = 1e9;
  for (const Eigen::Vector3d& point : run.loop().moment().map.points()) {
    nearest = std::min(nearest, (point - focus).norm());
  }
  // It is on a surface, and those have points of the map all over.
  EXPECT_LT(nearest, 0.1 * (picture.world_from_view->translation - focus).norm());
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

TEST(Box, WhatIsAlwaysWrongIsOnEveryPicture) {
  const TempDir dir;
  BoxRun run({}, dir.path());
  run.loop().always_show("on the last good settings: lumibox.toml:2: no TOML");
  for (const double time_s : {0.1, 1.0}) {
    run.until(time_s);
    ASSERT_EQ(run.loop().picture().alerts.size(), 1U);
    EXPECT_NE(run.loop().picture().alerts.front().find("lumibox.toml:2"), std::string::npos);
  }
}

TEST(Box, WhatIsRecordedBeforeTheCameraFailsIsFinished) {
  const TempDir dir;
  BoxRun run(kCapture, dir.path(), 4.5);
  int over = 0;
  const auto still_under_way = [&] {
    ++over;
    EXPECT_TRUE(lightfield::load_capture(dir / "capture-0001").points.empty());
  };
  EXPECT_THROW(run.loop().run_and_finish([] { return true; }, still_under_way), config::InputError);
  EXPECT_EQ(over, 1) << "the service manager is told before what may take longer than it waits";
  const auto capture = lightfield::load_capture(dir / "capture-0001");
  EXPECT_EQ(capture.light_field.perspectives().size(), run.views());
  EXPECT_FALSE(capture.points.empty());
}

/// RMSE of the perspectives' centres after one alignment of all, as a share of the walk's extent.
double error_percent(const lightfield::LightField& light_field, const hal::Scene& scene) {
  std::vector<hal::StampedPose> estimate;
  std::vector<hal::StampedPose> truth;
  for (const auto& p : light_field.perspectives()) {
    const double time_s = 1e-9 * static_cast<double>(p.timestamp_ns);
    estimate.push_back({time_s, p.world_from_camera});
    truth.push_back({time_s, scene.world_from_camera(time_s)});
  }
  return bench::compare_trajectories(estimate, truth).value().rmse_percent.value();
}

/// What is on disk when the power goes, two thirds through the walk.
void walk_until_the_power_goes(const std::filesystem::path& left) {
  const TempDir dir;
  BoxRun run(kCapture, dir.path());
  run.until(5.0);
  EXPECT_GE(run.views(), 4U);
  std::filesystem::copy(dir.path(), left, std::filesystem::copy_options::recursive);
}

TEST(Box, GoesOnInTheSameWorldAfterThePowerWasGone) {
  const TempDir dir;
  walk_until_the_power_goes(dir.path());
  const auto before = lightfield::load_capture(dir / "capture-0001").light_field;
  BoxRun run({}, dir.path());
  EXPECT_EQ(run.views(), before.perspectives().size());
  // The walk begins where the map does; a lost frame describes two of its keyframes at most.
  run.until(0.5);
  EXPECT_EQ(run.loop().mode(), ModeId::Capture);
  run.until(6.4);
  EXPECT_EQ(run.loop().mode(), ModeId::Capture);
  EXPECT_GT(run.views(), before.perspectives().size());
  run.loop().finish();

  EXPECT_FALSE(std::filesystem::exists(dir / "capture-0002"));
  const auto both = lightfield::load_capture(dir / "capture-0001").light_field;
  EXPECT_EQ(both.perspectives().size(), run.views());
  // 0.5 %: a walk of seconds in a picture of 160 pixels; of two worlds with scales of their own the
  // error would be tens of percent.
  const auto scene = hal::load_scene(kScene);
  EXPECT_LT(error_percent(both, *scene), 0.5);
  const auto& sphere = *before.subject();
  EXPECT_LT((both.subject()->center - sphere.center).norm(), 0.05 * sphere.radius);
}

/// The same room with other pictures on everything.
std::string repainted(std::string scene) {
  for (const auto& [found, other] :
       {std::pair("seed = 31", "seed = 32"), {"seed = 3\n", "seed = 4\n"}}) {
    scene.replace(scene.find(found), std::string_view(found).size(), other);
  }
  return scene;
}

TEST(Box, NeverBeginsANewWorldByItselfWhereItDoesNotKnowThePlace) {
  const TempDir dir;
  walk_until_the_power_goes(dir.path());
  const auto before = contents(dir.path());
  const std::vector<TimedPress> presses = {{1.0, {Button::Main, Press::Short}},
                                           {2.0, {Button::Main, Press::Short}},
                                           {3.0, {Button::Main, Press::Long}}};
  const TempDir elsewhere;
  BoxRun run(presses, dir.path(), 1e9,
             elsewhere.write("scene.toml", repainted(testing::read_text(kScene))));
  run.until(2.9);
  EXPECT_EQ(run.loop().mode(), ModeId::Resume);
  EXPECT_EQ(run.loop().moment().tracked.reason, tracking::TrackingReason::Relocalising);
  EXPECT_TRUE(contents(dir.path()) == before);
  run.until(6.0);
  EXPECT_EQ(run.loop().mode(), ModeId::Subject) << "asked for, a new world begins";
}

TEST(Box, CaptureWithADamagedMapIsStillShown) {
  const TempDir dir;
  walk_until_the_power_goes(dir.path());
  dir.write("capture-0001/map/map.json", "{\"version\": 1");
  BoxRun run({{1.0, {Button::Review, Press::Short}}}, dir.path());
  run.until(0.9);
  EXPECT_EQ(run.loop().mode(), ModeId::Resume);
  ASSERT_EQ(run.loop().picture().alerts.size(), 1U);
  EXPECT_NE(run.loop().picture().alerts[0].find("map/map.json"), std::string::npos);
  run.until(1.2);
  EXPECT_EQ(run.loop().mode(), ModeId::Review);
  EXPECT_GT(mean_brightness(run.screen()), 20.0) << "grey levels: a picture, not a black screen";
}

TEST(Box, LostPicturesAreSaidOnceAndTheOthersAreShown) {
  const TempDir dir;
  BoxRun run(kCapture, dir.path());
  run.until(6.3);
  ASSERT_GE(run.views(), 6U);
  for (const char* picture : {"000001.jpg", "000002.jpg"}) {
    std::filesystem::remove(dir / "capture-0001/images" / picture);
  }
  EXPECT_TRUE(run.loop().picture().alerts.empty()) << "nobody has looked yet";
  run.until(6.9);
  EXPECT_EQ(run.loop().mode(), ModeId::Review);
  ASSERT_EQ(run.loop().picture().alerts.size(), 1U);
  EXPECT_NE(run.loop().picture().alerts[0].find("2 of "), std::string::npos);
  EXPECT_NE(run.loop().picture().alerts[0].find("images/000001.jpg"), std::string::npos);
  EXPECT_GT(mean_brightness(run.screen()), 20.0) << "grey levels: a picture, not a black screen";
  EXPECT_NO_THROW(run.loop().finish());
}

/// What is seen and what is left of a run in which the GPU is reset at some times.
struct RunWithResets {
  std::vector<hal::Image> screens;
  std::map<std::string, std::string> files;

  explicit RunWithResets(const std::vector<double>& resets_s) {
    std::vector<TimedPress> presses = kCapture;
    presses.push_back({7.0, {Button::Main, Press::Short}});  // the wide aperture
    const TempDir dir;
    BoxRun run(presses, dir.path());
    for (const double time_s : {5.0, 6.5, 6.7, 7.2}) {
      run.until(time_s);
      if (std::ranges::find(resets_s, time_s) != resets_s.end()) run.display().lose();
      run.until(time_s + 0.15);
      screens.push_back(run.screen());
    }
    EXPECT_EQ(run.loop().mode(), ModeId::Review);
    run.loop().finish();
    files = contents(dir.path());
  }
};

// While it captures and while it reviews, on the shape and on planes. What was recorded since the
// start is on the GPU as the camera gave it, after a reset as its file has it; so both runs have
// one when review begins.
TEST(Box, GoesOnAsIfNothingHadHappenedAfterTheGpuWasReset) {
  const RunWithResets once({6.5});
  const RunWithResets often({5.0, 6.5, 6.7, 7.2});
  EXPECT_TRUE(often.screens == once.screens);
  EXPECT_TRUE(often.files == once.files);
  for (const hal::Image& screen : once.screens) {
    EXPECT_GT(mean_brightness(screen), 20.0) << "grey levels: a picture, not a black screen";
  }
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
