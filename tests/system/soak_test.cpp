// The tracker on a path that is walked to and fro for ever: what it keeps must not grow with the
// time. Three quarters of a simulated minute by default; an hour with LUMIBOX_SOAK_MINUTES=60.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "bench/footage.h"
#include "hal/sim/random.h"
#include "hal/sim/random_scene.h"
#include "tracking/tracker.h"

namespace lumibox {
namespace {

constexpr double kFps = 30.0;
constexpr std::int64_t kFrames = 150;                 // of the path, one way
constexpr std::int64_t kFramesBetweenReports = 3600;  // two minutes

double minutes() {
  const char* text = std::getenv("LUMIBOX_SOAK_MINUTES");
  return text != nullptr ? std::atof(text) : 0.75;
}

/// A desk and the way around it, small enough that an hour of it is tracked in minutes.
bench::Footage film_path() {
  hal::sim::SceneSpec spec =
      hal::sim::random_scene({1, hal::sim::Place::Desk, hal::sim::Walk::Arc, {}});
  spec.camera = geometry::Camera(spec.camera).at_level(1).profile();
  return bench::film_scene("soak", hal::make_scene(spec), kFrames);
}

/// The path to and fro, every picture once or, in every other round, every second one.
class Walker {
 public:
  /// Index of the next picture.
  std::int64_t next() {
    const std::int64_t now = at_;
    const std::int64_t step = rounds_ % 2 == 0 ? 1 : 2;
    if (at_ + step * way_ < 0 || at_ + step * way_ >= kFrames) {
      way_ = -way_;
      if (way_ > 0) ++rounds_;
    }
    at_ += step * way_;
    return now;
  }
  int rounds() const { return rounds_; }

 private:
  std::int64_t at_ = 0;
  std::int64_t way_ = 1;
  int rounds_ = 0;
};

/// The picture as a sensor would have it another time: uniform noise of 2 grey levels (root mean
/// square), never twice the same.
hal::Image with_noise(const hal::Image& picture, std::uint64_t seed) {
  hal::Image noisy = picture;
  hal::sim::Random random(seed);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < noisy.size_bytes(); ++i) {
    bits = i % 8 == 0 ? random.bits() : bits >> 8U;
    const int change = static_cast<int>((bits & 0xffU) * 7U >> 8U) - 3;
    noisy.data()[i] = static_cast<std::uint8_t>(std::clamp(noisy.data()[i] + change, 0, 255));
  }
  return noisy;
}

/// What the program holds of the heap. Sanitizers have a heap of their own, of which this tells
/// nothing.
double heap_mib() {
  const struct mallinfo2 heap = mallinfo2();
  return static_cast<double>(heap.uordblks + heap.hblkhd) / (1024.0 * 1024.0);
}

struct Held {
  double heap_mib = 0.0;
  int keyframes = 0;
  int points = 0;
};

Held held_by(const tracking::Tracker& tracker) {
  const tracking::TrackerStatistics statistics = tracker.statistics();
  return {heap_mib(), statistics.keyframes, statistics.points};
}

void report(std::int64_t frames, const Held& held) {
  std::printf("%6.1f min: %.1f MiB, %d keyframes, %d points\n",
              static_cast<double>(frames) / kFps / 60.0, held.heap_mib, held.keyframes,
              held.points);
  std::fflush(stdout);
}

TEST(Soak, WhatTheTrackerHoldsDoesNotGrowWithTime) {
  const bench::Footage path = film_path();
  ASSERT_EQ(std::ssize(path.frames), kFrames);
  tracking::Tracker tracker(path.camera, config::Tracking(), tracking::Mapping::Lockstep, 0);
  const auto frames = static_cast<std::int64_t>(minutes() * 60.0 * kFps);
  Walker walker;
  std::int64_t lost = 0;
  std::int64_t tracked = 0;
  std::optional<Held> settled;  // once the path has been walked at both speeds
  for (std::int64_t i = 0; i < frames; ++i) {
    const auto time_ns = static_cast<std::int64_t>(static_cast<double>(i) * 1e9 / kFps);
    const auto& picture = *path.frames[static_cast<std::size_t>(walker.next())].gray;
    const auto seed = static_cast<std::uint64_t>(i);
    const auto result = tracker.track(with_noise(picture, seed), i, time_ns);
    if (result.world_from_camera) ++tracked;
    if (tracked > 0 && !result.world_from_camera) ++lost;
    if (!settled && walker.rounds() == 2) settled = held_by(tracker);
    if ((i + 1) % kFramesBetweenReports == 0) report(i + 1, held_by(tracker));
  }
  ASSERT_TRUE(settled) << "too short a soak to say anything";
  const Held end = held_by(tracker);
  EXPECT_EQ(lost, 0);
  EXPECT_GT(tracked, frames - kFrames);
  // A place that was seen twice is known; now and then the noise still makes a new point of it.
  EXPECT_LE(end.keyframes, settled->keyframes + settled->keyframes / 4 + 1);
  EXPECT_LE(end.points, settled->points + settled->points / 4);
  EXPECT_LE(end.heap_mib, 1.25 * settled->heap_mib + 1.0);
}

}  // namespace
}  // namespace lumibox
