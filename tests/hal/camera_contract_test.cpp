#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hal/fake_libcamera.h"
#include "hal/fake_video.h"
#include "hal/libcamera/libcamera_camera.h"
#include "hal/replay/replay_camera.h"
#include "hal/sim/scene.h"
#include "hal/sim/sim_camera.h"
#include "hal/sim/virtual_clock.h"
#include "hal/system_clock.h"
#include "hal/v4l2/v4l2_camera.h"
#include "support/recording.h"
#include "support/temp_dir.h"

// What every camera promises, whatever is behind it. A new backend adds a line to the list at the
// end and must pass all of it.
namespace lumibox::hal {
namespace {

using testing::FakeCamera;
using testing::FakeLibcamera;
using testing::FakeSensor;
using testing::FakeVideo;
using testing::Recording;
using testing::TempDir;

constexpr std::int64_t kFrames = 5;
constexpr std::int64_t kPeriodNs = 100'000'000;

/// A camera and whatever it needs. Those in memory give kFrames frames at least, one each kPeriodNs
/// of a virtual clock.
class Rig {
 public:
  virtual ~Rig() = default;
  virtual std::unique_ptr<Camera> open() = 0;
  virtual Clock& clock() { return clock_; }

  /// Whether grey is made of the colours; else it is the luma that the camera gave, which the
  /// colours are made of, and rounded otherwise.
  virtual bool gray_is_of_color() const { return true; }

 private:
  VirtualClock clock_;
};

class ReplayRig : public Rig {
 public:
  ReplayRig(Recording::Medium medium, Pacing pacing)
      : recording_(medium, kFrames), pacing_(pacing) {}

  std::unique_ptr<Camera> open() override {
    return std::make_unique<ReplayCamera>(open_sequence(recording_.folder()), clock(), pacing_);
  }

 private:
  Recording recording_;
  Pacing pacing_;
};

class SimRig : public Rig {
 public:
  std::unique_ptr<Camera> open() override {
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
    return std::make_unique<SimCamera>(load_scene(folder_.write("block.toml", kScene)), clock());
  }

 private:
  TempDir folder_;
};

/// A webcam in memory, looked after by whoever takes frames.
class V4l2Rig : public Rig {
 public:
  explicit V4l2Rig(std::uint32_t fourcc) : fourcc_(fourcc) {}

  std::unique_ptr<Camera> open() override {
    auto webcam = std::make_shared<FakeCamera>();
    webcam->modes = {{fourcc_, Recording::kWidth, Recording::kHeight, {10}}};
    webcam->controls = testing::webcam_controls();
    return std::make_unique<V4l2Camera>(
        CameraOptions{}, clock(),
        std::make_unique<FakeVideo>(clock(), std::vector<std::shared_ptr<FakeCamera>>{webcam}),
        Service::Caller);
  }

  bool gray_is_of_color() const override { return false; }

 private:
  std::uint32_t fourcc_;
};

/// A camera of a board in memory, looked after by whoever takes frames.
class LibcameraRig : public Rig {
 public:
  explicit LibcameraRig(live::PixelFormat format) : format_(format) {}

  std::unique_ptr<Camera> open() override {
    const auto sensor = std::make_shared<FakeSensor>();
    sensor->offers = {testing::offer(format_, Recording::kWidth, Recording::kHeight)};
    CameraOptions options;
    options.wishes.rate_hz = 10.0;
    return std::make_unique<LibcameraCamera>(
        options, clock(),
        std::make_unique<FakeLibcamera>(clock(), std::vector<std::shared_ptr<FakeSensor>>{sensor}),
        Service::Caller);
  }

  bool gray_is_of_color() const override { return format_ == live::PixelFormat::Bgr; }

 private:
  live::PixelFormat format_;
};

/// The camera that LUMIBOX_TEST_VIDEO (a path, a name or auto) or LUMIBOX_TEST_LIBCAMERA (a number,
/// an id, a name or auto) names, in real time.
template <typename RealCamera>
class RealRig : public Rig {
 public:
  explicit RealRig(std::string device) : device_(std::move(device)) {}

  std::unique_ptr<Camera> open() override {
    CameraOptions options;
    options.device = device_;
    return std::make_unique<RealCamera>(options, clock_);
  }

  Clock& clock() override { return clock_; }
  bool gray_is_of_color() const override { return false; }

 private:
  std::string device_;
  SystemClock clock_;
};

struct Backend {
  const char* name;
  std::function<std::unique_ptr<Rig>()> make_rig;  ///< null if this machine has no such camera
};

/// gtest names the tests by the backend.
std::string name_of(const ::testing::TestParamInfo<Backend>& info) {
  return info.param.name;
}

class CameraTest : public ::testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    rig_ = GetParam().make_rig();
    if (!rig_) GTEST_SKIP() << "the environment names no camera; see RealRig";
    camera_ = rig_->open();
    period_ns_ = std::llround(1e9 / camera_->profile().fps);
  }

  /// Polls four times per period until there are so many frames or no more will come.
  std::vector<Frame> play(Camera& camera, std::size_t count = kFrames) {
    constexpr int kPatiencePeriods = 100;  // real cameras take a while for their first frame
    std::vector<Frame> frames;
    for (int poll = 0; poll < 4 * kPatiencePeriods && frames.size() < count &&
                       camera.state() == CameraState::Streaming;
         ++poll) {
      if (std::optional<Frame> frame = camera.take_newest()) {
        frames.push_back(*std::move(frame));
      } else {
        advance(period_ns_ / 4);
      }
    }
    return frames;
  }

  std::optional<Frame> next_frame() {
    const std::vector<Frame> frames = play(*camera_, 1);
    return frames.empty() ? std::nullopt : std::optional(frames.front());
  }

  void advance(std::int64_t ns) { rig_->clock().wait_until(rig_->clock().now_ns() + ns); }

  std::unique_ptr<Rig> rig_;
  std::unique_ptr<Camera> camera_;
  std::int64_t period_ns_ = 0;
};

using EveryCamera = CameraTest;

TEST_P(EveryCamera, IsStoppedBeforeStart) {
  EXPECT_EQ(camera_->state(), CameraState::Stopped);
  EXPECT_FALSE(camera_->take_newest());
  advance(period_ns_);
  EXPECT_FALSE(camera_->take_newest());
  EXPECT_EQ(camera_->counters().delivered, 0);
}

/// Mean difference of two pictures, in grey levels.
double mean_difference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size_bytes(); ++i) sum += std::abs(a.data()[i] - b.data()[i]);
  return sum / static_cast<double>(a.size_bytes());
}

TEST_P(EveryCamera, GivesBothPicturesInTheProfilesSize) {
  camera_->start();
  const std::vector<Frame> frames = play(*camera_);
  ASSERT_FALSE(frames.empty());
  for (const Frame& frame : frames) {
    ASSERT_TRUE(frame.color && frame.gray);
    EXPECT_EQ(frame.color->width(), camera_->profile().width);
    EXPECT_EQ(frame.color->height(), camera_->profile().height);
    EXPECT_EQ(frame.color->channels(), 3);
    const Image gray = to_gray(*frame.color);
    ASSERT_EQ(frame.gray->size_bytes(), gray.size_bytes());
    // Colours that no screen has are clipped, which moves their luma.
    constexpr double kClippedLevels = 4.0;
    if (rig_->gray_is_of_color()) {
      EXPECT_EQ(*frame.gray, gray);
    } else {
      EXPECT_LT(mean_difference(*frame.gray, gray), kClippedLevels);
    }
  }
}

TEST_P(EveryCamera, GivesEachFrameOnceAndInOrder) {
  camera_->start();
  EXPECT_EQ(camera_->state(), CameraState::Streaming);
  const std::vector<Frame> frames = play(*camera_);
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_GT(frames[i].index, frames[i - 1].index);
    EXPECT_GT(frames[i].timestamp_ns, frames[i - 1].timestamp_ns);
  }
  EXPECT_EQ(camera_->counters().delivered, kFrames);
  // All that were made were delivered or counted as dropped; a real one may have made more since.
  EXPECT_GE(camera_->counters().dropped + kFrames, frames.back().index + 1);
}

TEST_P(EveryCamera, StopsInTheMiddle) {
  camera_->start();
  ASSERT_TRUE(next_frame());
  camera_->stop();
  EXPECT_EQ(camera_->state(), CameraState::Stopped);
  advance(period_ns_);
  EXPECT_FALSE(camera_->take_newest());
}

TEST_P(EveryCamera, BeginsAnewAfterAStop) {
  camera_->start();
  ASSERT_TRUE(next_frame());
  camera_->stop();
  advance(period_ns_);

  camera_->start();
  EXPECT_EQ(play(*camera_).size(), static_cast<std::size_t>(kFrames));
  camera_->start();
  const std::optional<Frame> again = next_frame();
  ASSERT_TRUE(again);
  EXPECT_LT(again->index, kFrames);
  EXPECT_EQ(camera_->counters().delivered, 1 + kFrames + 1);
}

TEST_P(EveryCamera, LeavesAFrameThatIsKeptAlone) {
  camera_->start();
  const std::optional<Frame> kept = next_frame();
  ASSERT_TRUE(kept);
  const Image copy = *kept->color;
  play(*camera_);
  camera_.reset();
  EXPECT_EQ(*kept->color, copy);
}

TEST_P(EveryCamera, TakesAnExposureLockAtAnyTime) {
  camera_->lock_exposure(true);
  camera_->start();
  camera_->lock_exposure(false);
  EXPECT_TRUE(next_frame());
  camera_->lock_exposure(true);
  EXPECT_TRUE(next_frame());
}

/// Cameras in memory, that make the same frames each time.
using RepeatingCamera = CameraTest;

TEST_P(RepeatingCamera, MissesNoFrame) {
  camera_->start();
  const std::vector<Frame> frames = play(*camera_);
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].color->width(), Recording::kWidth);
    EXPECT_EQ(frames[i].color->height(), Recording::kHeight);
    EXPECT_EQ(frames[i].index, static_cast<std::int64_t>(i));
    if (i > 0) {
      EXPECT_EQ(frames[i].timestamp_ns - frames[i - 1].timestamp_ns, kPeriodNs);
      EXPECT_NE(*frames[i].color, *frames[i - 1].color);
    }
  }
  EXPECT_EQ(camera_->counters().dropped, 0);
}

TEST_P(RepeatingCamera, BeginsWithTheFirstFrame) {
  camera_->start();
  const std::shared_ptr<const Image> first = next_frame().value().color;
  play(*camera_);
  camera_->start();
  const Frame again = next_frame().value();
  EXPECT_EQ(again.index, 0);
  EXPECT_EQ(*again.color, *first);
}

TEST_P(RepeatingCamera, GivesTheSameBitsTwice) {
  camera_->start();
  const std::vector<Frame> first = play(*camera_);
  const std::unique_ptr<Camera> other = rig_->open();
  other->start();
  const std::vector<Frame> second = play(*other);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(*first[i].color, *second[i].color);
  }
}

/// Cameras that are over some time.
using RecordedCamera = CameraTest;

TEST_P(RecordedCamera, EndsAndGivesNothingMore) {
  camera_->start();
  play(*camera_);
  EXPECT_EQ(camera_->state(), CameraState::Ended);
  advance(10 * kPeriodNs);
  EXPECT_FALSE(camera_->take_newest());
  EXPECT_EQ(camera_->state(), CameraState::Ended);
}

/// Cameras in memory whose frames come when their time has come.
using PacedCamera = CameraTest;

TEST_P(PacedCamera, HasNothingNewUntilTimeAdvances) {
  camera_->start();
  EXPECT_TRUE(next_frame());
  EXPECT_FALSE(camera_->take_newest());
  advance(kPeriodNs / 2);
  EXPECT_FALSE(camera_->take_newest());
  advance(kPeriodNs);
  EXPECT_TRUE(camera_->take_newest());
}

TEST_P(PacedCamera, GivesTheNewestAndCountsWhatItDisplaced) {
  camera_->start();
  ASSERT_EQ(next_frame().value().index, 0);
  advance(3 * kPeriodNs + kPeriodNs / 2);
  EXPECT_EQ(camera_->take_newest().value().index, 3);
  EXPECT_FALSE(camera_->take_newest());
  EXPECT_EQ(camera_->counters().delivered, 2);
  EXPECT_EQ(camera_->counters().dropped, 2);
}

using PacedRecordedCamera = CameraTest;

TEST_P(PacedRecordedCamera, GivesTheLastFrameAfterALeapBeyondTheEnd) {
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

Backend v4l2(const char* name, std::uint32_t fourcc) {
  return {name, [=] { return std::make_unique<V4l2Rig>(fourcc); }};
}

Backend libcamera(const char* name, live::PixelFormat format) {
  return {name, [=] { return std::make_unique<LibcameraRig>(format); }};
}

template <typename RealCamera>
Backend real(const char* name, const char* variable) {
  return {name, [variable]() -> std::unique_ptr<Rig> {
            const char* device = std::getenv(variable);
            if (device == nullptr) return nullptr;
            return std::make_unique<RealRig<RealCamera>>(device);
          }};
}

const Backend kSim{"Sim", [] { return std::make_unique<SimRig>(); }};
const Backend kImages = replay("ReplayOfImages", Recording::Medium::Images, Pacing::Recorded);
const Backend kVideo = replay("ReplayOfVideo", Recording::Medium::Video, Pacing::Recorded);
const Backend kLockstep = replay("ReplayInLockstep", Recording::Medium::Images, Pacing::Lockstep);
const Backend kVideoLockstep =
    replay("ReplayOfVideoInLockstep", Recording::Medium::Video, Pacing::Lockstep);
const Backend kMjpeg = v4l2("V4l2Mjpeg", V4L2_PIX_FMT_MJPEG);
const Backend kYuyv = v4l2("V4l2Yuyv", V4L2_PIX_FMT_YUYV);
const Backend kNv12 = libcamera("LibcameraNv12", live::PixelFormat::Nv12);
const Backend kBgr = libcamera("LibcameraBgr", live::PixelFormat::Bgr);
const Backend kRealVideo = real<V4l2Camera>("RealVideo", "LUMIBOX_TEST_VIDEO");
const Backend kRealLibcamera = real<LibcameraCamera>("RealLibcamera", "LUMIBOX_TEST_LIBCAMERA");

INSTANTIATE_TEST_SUITE_P(Backends, EveryCamera,
                         ::testing::Values(kSim, kImages, kVideo, kLockstep, kVideoLockstep, kMjpeg,
                                           kYuyv, kNv12, kBgr, kRealVideo, kRealLibcamera),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Backends, RepeatingCamera,
                         ::testing::Values(kSim, kImages, kVideo, kLockstep, kVideoLockstep, kMjpeg,
                                           kYuyv, kNv12, kBgr),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Backends, RecordedCamera,
                         ::testing::Values(kSim, kImages, kVideo, kLockstep, kVideoLockstep),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Backends, PacedCamera,
                         ::testing::Values(kSim, kImages, kVideo, kMjpeg, kYuyv, kNv12, kBgr),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Backends, PacedRecordedCamera, ::testing::Values(kSim, kImages, kVideo),
                         name_of);

}  // namespace
}  // namespace lumibox::hal
