#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "hal/replay/replay_camera.h"
#include "hal/sim/scene.h"
#include "hal/sim/sim_camera.h"
#include "hal/sim/virtual_clock.h"
#include "support/recording.h"
#include "support/temp_dir.h"

// What every camera promises, whatever is behind it. A new backend adds a line to the list at the
// end and must pass all of it.
namespace lumibox::hal {
namespace {

using testing::Recording;
using testing::TempDir;

constexpr std::int64_t kFrames = 5;
constexpr std::int64_t kPeriodNs = 100'000'000;

/// A camera of kFrames frames, one each kPeriodNs, and whatever it needs on disk.
class Rig {
 public:
  virtual ~Rig() = default;
  virtual std::unique_ptr<Camera> open(const Clock& clock) = 0;
};

class ReplayRig : public Rig {
 public:
  ReplayRig(Recording::Medium medium, Pacing pacing)
      : recording_(medium, kFrames), pacing_(pacing) {}

  std::unique_ptr<Camera> open(const Clock& clock) override {
    return std::make_unique<ReplayCamera>(open_sequence(recording_.folder()), clock, pacing_);
  }

 private:
  Recording recording_;
  Pacing pacing_;
};

class SimRig : public Rig {
 public:
  std::unique_ptr<Camera> open(const Clock& clock) override {
    constexpr const char* kScene = R"(
duration_s = 0.5
[camera]
width = 32
height = 24
fx = 30.0
fps = 10.0
[subject]
center = [0.0, 0.0, 0.0]
radius_m = 0.5
[[textures]]
name = "squares"
pattern = "checker"
texels = [64, 64]
cell_m = 0.25
palette = [[0.9, 0.2, 0.1], [0.1, 0.3, 0.8]]
[[objects]]
name = "block"
shape = "box"
size = [1.0, 1.0, 1.0]
texture = "squares"
[[lights]]
kind = "ambient"
[path]
keys = [
  { time_s = 0.0, at = [2.0, 0.0, 1.0], target = [0.0, 0.0, 0.0] },
  { time_s = 0.5, at = [2.0, 1.0, 1.0], target = [0.0, 0.0, 0.0] },
]
)";
    return std::make_unique<SimCamera>(load_scene(folder_.write("block.toml", kScene)), clock);
  }

 private:
  TempDir folder_;
};

struct Backend {
  const char* name;
  std::function<std::unique_ptr<Rig>()> make_rig;
};

/// gtest names the tests by the backend.
std::string name_of(const ::testing::TestParamInfo<Backend>& info) {
  return info.param.name;
}

class CameraTest : public ::testing::TestWithParam<Backend> {
 protected:
  /// Polls four times per period until the camera has ended.
  std::vector<Frame> play(Camera& camera) {
    std::vector<Frame> frames;
    for (std::int64_t poll = 0; poll < 8 * kFrames && camera.state() == CameraState::Streaming;
         ++poll) {
      if (std::optional<Frame> frame = camera.take_newest()) {
        frames.push_back(*std::move(frame));
      }
      advance(kPeriodNs / 4);
    }
    return frames;
  }

  void advance(std::int64_t ns) { clock_.wait_until(clock_.now_ns() + ns); }

  VirtualClock clock_;
  std::unique_ptr<Rig> rig_ = GetParam().make_rig();
  std::unique_ptr<Camera> camera_ = rig_->open(clock_);
};

using EveryCamera = CameraTest;

TEST_P(EveryCamera, IsStoppedBeforeStart) {
  EXPECT_EQ(camera_->state(), CameraState::Stopped);
  EXPECT_FALSE(camera_->take_newest());
  advance(kPeriodNs);
  EXPECT_FALSE(camera_->take_newest());
  EXPECT_EQ(camera_->counters().delivered, 0);
}

TEST_P(EveryCamera, GivesBothPicturesInTheProfilesSize) {
  EXPECT_EQ(camera_->profile().width, Recording::kWidth);
  EXPECT_EQ(camera_->profile().height, Recording::kHeight);
  camera_->start();
  for (const Frame& frame : play(*camera_)) {
    ASSERT_TRUE(frame.color && frame.gray);
    EXPECT_EQ(frame.color->width(), Recording::kWidth);
    EXPECT_EQ(frame.color->height(), Recording::kHeight);
    EXPECT_EQ(frame.color->channels(), 3);
    EXPECT_EQ(*frame.gray, to_gray(*frame.color));
  }
}

TEST_P(EveryCamera, GivesEachFrameOnceAndInOrder) {
  camera_->start();
  const std::vector<Frame> frames = play(*camera_);
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].index, static_cast<std::int64_t>(i));
    if (i > 0) {
      EXPECT_EQ(frames[i].timestamp_ns - frames[i - 1].timestamp_ns, kPeriodNs);
      EXPECT_NE(*frames[i].color, *frames[i - 1].color);
    }
  }
  EXPECT_EQ(camera_->counters().delivered, kFrames);
  EXPECT_EQ(camera_->counters().dropped, 0);
}

TEST_P(EveryCamera, EndsAndGivesNothingMore) {
  camera_->start();
  EXPECT_EQ(camera_->state(), CameraState::Streaming);
  play(*camera_);
  EXPECT_EQ(camera_->state(), CameraState::Ended);
  advance(10 * kPeriodNs);
  EXPECT_FALSE(camera_->take_newest());
  EXPECT_EQ(camera_->state(), CameraState::Ended);
}

TEST_P(EveryCamera, StopsInTheMiddle) {
  camera_->start();
  ASSERT_TRUE(camera_->take_newest());
  camera_->stop();
  EXPECT_EQ(camera_->state(), CameraState::Stopped);
  advance(kPeriodNs);
  EXPECT_FALSE(camera_->take_newest());
}

TEST_P(EveryCamera, BeginsAnewAfterAStopAndAfterTheEnd) {
  camera_->start();
  const std::shared_ptr<const Image> first = camera_->take_newest().value().color;
  camera_->stop();
  advance(kPeriodNs);

  camera_->start();
  EXPECT_EQ(play(*camera_).size(), static_cast<std::size_t>(kFrames));
  camera_->start();
  const Frame again = camera_->take_newest().value();
  EXPECT_EQ(again.index, 0);
  EXPECT_EQ(*again.color, *first);
  EXPECT_EQ(camera_->counters().delivered, 1 + kFrames + 1);
}

TEST_P(EveryCamera, LeavesAFrameThatIsKeptAlone) {
  camera_->start();
  const Frame kept = camera_->take_newest().value();
  const Image copy = *kept.color;
  play(*camera_);
  camera_.reset();
  EXPECT_EQ(*kept.color, copy);
}

TEST_P(EveryCamera, GivesTheSameBitsTwice) {
  camera_->start();
  const std::vector<Frame> first = play(*camera_);
  const std::unique_ptr<Camera> other = rig_->open(clock_);
  other->start();
  const std::vector<Frame> second = play(*other);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(*first[i].color, *second[i].color);
  }
}

TEST_P(EveryCamera, TakesAnExposureLockAtAnyTime) {
  camera_->lock_exposure(true);
  camera_->start();
  camera_->lock_exposure(false);
  EXPECT_TRUE(camera_->take_newest());
}

/// Cameras whose frames come when their time has come.
using PacedCamera = CameraTest;

TEST_P(PacedCamera, HasNothingNewUntilTimeAdvances) {
  camera_->start();
  EXPECT_TRUE(camera_->take_newest());
  EXPECT_FALSE(camera_->take_newest());
  advance(kPeriodNs / 2);
  EXPECT_FALSE(camera_->take_newest());
  advance(kPeriodNs);
  EXPECT_TRUE(camera_->take_newest());
}

TEST_P(PacedCamera, GivesTheNewestAndCountsWhatItDisplaced) {
  camera_->start();
  ASSERT_EQ(camera_->take_newest().value().index, 0);
  advance(3 * kPeriodNs + kPeriodNs / 2);
  EXPECT_EQ(camera_->take_newest().value().index, 3);
  EXPECT_FALSE(camera_->take_newest());
  EXPECT_EQ(camera_->counters().delivered, 2);
  EXPECT_EQ(camera_->counters().dropped, 2);
}

TEST_P(PacedCamera, GivesTheLastFrameAfterALeapBeyondTheEnd) {
  camera_->start();
  advance(100 * kPeriodNs);
  EXPECT_EQ(camera_->take_newest().value().index, kFrames - 1);
  EXPECT_EQ(camera_->counters().dropped, kFrames - 1);
  EXPECT_EQ(camera_->state(), CameraState::Ended);
}

TEST(ReplayCamera, ALoopAtTheRateOfTheRecordingMissesNoFrameThroughRoundedStamps) {
  constexpr int kManyFrames = 12;
  const Recording recording(Recording::Medium::Images, kManyFrames);
  std::string list;
  for (int i = 0; i < kManyFrames; ++i) {
    list += std::to_string(5.0 + i / 30.0) + " " + Recording::name(i) + "\n";  // microseconds
  }
  recording.dir().write("rgb.txt", list);
  recording.dir().write("calib.txt", "30 31 15.5 11.5 0 0 0 0 32 24 30\n");
  VirtualClock clock;
  ReplayCamera camera(open_sequence(recording.folder()), clock, Pacing::Recorded);
  camera.start();
  for (int i = 0; i < kManyFrames; ++i) {
    const auto frame = camera.take_newest();
    ASSERT_TRUE(frame) << i;
    EXPECT_EQ(frame->index, i);
    clock.wait_until(clock.now_ns() + 33'333'333);
  }
  EXPECT_EQ(camera.counters().dropped, 0);
}

Backend replay(const char* name, Recording::Medium medium, Pacing pacing) {
  return {name, [=] { return std::make_unique<ReplayRig>(medium, pacing); }};
}

const Backend kSim{"Sim", [] { return std::make_unique<SimRig>(); }};
const Backend kImages = replay("ReplayOfImages", Recording::Medium::Images, Pacing::Recorded);
const Backend kVideo = replay("ReplayOfVideo", Recording::Medium::Video, Pacing::Recorded);
const Backend kLockstep = replay("ReplayInLockstep", Recording::Medium::Images, Pacing::Lockstep);
const Backend kVideoLockstep =
    replay("ReplayOfVideoInLockstep", Recording::Medium::Video, Pacing::Lockstep);

INSTANTIATE_TEST_SUITE_P(Backends, EveryCamera,
                         ::testing::Values(kSim, kImages, kVideo, kLockstep, kVideoLockstep),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Backends, PacedCamera, ::testing::Values(kSim, kImages, kVideo), name_of);

}  // namespace
}  // namespace lumibox::hal
