// The tracker on a path that is walked to and fro for ever: what it keeps must not grow with the
// time. A simulated minute by default; an hour with LUMIBOX_SOAK_MINUTES=60.
#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdio>
#include <cstdlib>

#include "bench/footage.h"
#include "hal/sim/random_scene.h"
#include "tracking/tracker.h"

namespace lumibox {
namespace {

constexpr double kFps = 30.0;
constexpr std::int64_t kFrames = 150;  // of the path, one way

double minutes() {
  const char* text = std::getenv("LUMIBOX_SOAK_MINUTES");
  return text != nullptr ? std::atof(text) : 1.0;
}

/// A desk and the way around it, small enough that an hour of it is tracked in minutes.
bench::Footage film_path() {
  hal::sim::SceneSpec spec =
      hal::sim::random_scene({1, hal::sim::Place::Desk, hal::sim::Walk::Arc, {}});
  const geometry::Camera half = geometry::Camera(spec.camera).at_level(1);
  spec.camera = half.profile();
  return bench::film_scene("soak", hal::make_scene(spec), kFrames);
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

TEST(Soak, WhatTheTrackerHoldsDoesNotGrowWithTime) {
  const bench::Footage path = film_path();
  ASSERT_EQ(std::ssize(path.frames), kFrames);
  tracking::Tracker tracker(path.camera, config::Tracking(), tracking::Mapping::Lockstep, 0);
  const auto frames = static_cast<std::int64_t>(minutes() * 60.0 * kFps);
  const std::int64_t round = 2 * (kFrames - 1);
  std::int64_t lost = 0;
  std::int64_t tracked = 0;
  std::optional<Held> settled;  // once the path is known
  for (std::int64_t i = 0; i < frames; ++i) {
    const std::int64_t phase = i % round;
    const std::int64_t at = phase < kFrames ? phase : round - phase;
    const auto time_ns = static_cast<std::int64_t>(static_cast<double>(i) * 1e9 / kFps);
    const auto& picture = *path.frames[static_cast<std::size_t>(at)].gray;
    const auto result = tracker.track(picture, i, time_ns);
    if (result.world_from_camera) ++tracked;
    if (tracked > 0 && !result.world_from_camera) ++lost;
    if (i == 2 * round) settled = held_by(tracker);
    if (i % (10 * round) == 0) {
      const Held held = held_by(tracker);
      std::printf("%7.1f min: %.1f MiB, %d keyframes, %d points\n",
                  static_cast<double>(i) / kFps / 60.0, held.heap_mib, held.keyframes, held.points);
    }
  }
  ASSERT_TRUE(settled) << "too short a soak to say anything";
  const Held end = held_by(tracker);
  EXPECT_EQ(lost, 0);
  EXPECT_GT(tracked, frames - round);
  // A path walked twice is known; a place seen in another light or from a hand's breadth beside may
  // still add a little.
  EXPECT_LE(end.keyframes, settled->keyframes + settled->keyframes / 4 + 1);
  EXPECT_LE(end.points, settled->points + settled->points / 4);
  EXPECT_LE(end.heap_mib, 1.25 * settled->heap_mib + 1.0);
}

}  // namespace
}  // namespace lumibox
