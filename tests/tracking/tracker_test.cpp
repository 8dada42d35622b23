#include "tracking/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "geometry/rotation.h"
#include "support/pinhole.h"
#include "tracking/map_view.h"
#include "tracking/textured_world.h"

namespace lumibox::tracking {
namespace {

constexpr std::int64_t kPeriod = 33'333'333;

geometry::Pose walk_pose(int frame, double step) {
  return {geometry::exp_so3(Eigen::Vector3d(0.0, -0.004 * frame, 0.0)),
          Eigen::Vector3d(step * frame, 0.1 * step * frame, 0.0)};
}

std::vector<hal::Image> walk_sideways(const geometry::Camera& camera, int frames, double step) {
  std::vector<hal::Image> images;
  for (int i = 0; i < frames; ++i) {
    images.push_back(testing::render_wedge(camera, walk_pose(i, step)));
  }
  return images;
}

/// Rendered once for all tests of this file.
const std::vector<hal::Image>& walk() {
  static const std::vector<hal::Image> images = walk_sideways(testing::small_camera(), 24, 0.015);
  return images;
}

std::vector<TrackedFrame> run(Tracker& tracker, const std::vector<hal::Image>& images) {
  std::vector<TrackedFrame> frames;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto index = static_cast<std::int64_t>(i);
    frames.push_back(tracker.track(images[i], index, index * kPeriod));
  }
  return frames;
}

config::Tracking options() {
  config::Tracking o;
  o.pyramid_levels = 3;
  return o;
}

TEST(Tracker, StartsByItselfAndFollowsAStraightWalk) {
  Tracker tracker(testing::small_camera(), options(), Mapping::Lockstep, 1);
  const auto frames = run(tracker, walk());
  EXPECT_EQ(frames.front().state, TrackingState::Initialising);
  ASSERT_EQ(frames.back().state, TrackingState::Good);
  tracker.finish();
  // Centres lie on one line at equal steps: compare with the line through the first and the last.
  // 5 %: the tracked walk is a tenth of the scene's depth long, in a small picture.
  std::vector<Eigen::Vector3d> centers;
  for (const auto& f : frames) {
    if (!f.world_from_camera) continue;
    const geometry::Pose corrected =
        tracker.world_from_keyframe(f.keyframe).value() * f.keyframe_from_camera;
    centers.push_back(corrected.translation);
  }
  ASSERT_GT(centers.size(), 8U);
  const Eigen::Vector3d length = centers.back() - centers.front();
  for (std::size_t i = 0; i < centers.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(centers.size() - 1);
    EXPECT_LT((centers[i] - centers.front() - share * length).norm(), 0.05 * length.norm()) << i;
  }
}

// Or what a frame is said to cost would hold what on the box a thread beside it does.
TEST(Tracker, SaysWhenAFrameIsTrackedBeforeTheMapperHasItsTurn) {
  Tracker tracker(testing::small_camera(), options(), Mapping::Lockstep, 1);
  int calls = 0;
  int grown_afterwards = 0;
  for (std::size_t i = 0; i < walk().size(); ++i) {
    const auto index = static_cast<std::int64_t>(i);
    const int keyframes_before = tracker.statistics().keyframes;
    tracker.track(walk()[i], index, index * kPeriod, [&] {
      ++calls;
      if (keyframes_before > 0) {
        EXPECT_EQ(tracker.statistics().keyframes, keyframes_before);
      }
    });
    if (keyframes_before > 0 && tracker.statistics().keyframes > keyframes_before) {
      ++grown_afterwards;
    }
  }
  EXPECT_EQ(calls, static_cast<int>(walk().size()));
  EXPECT_GT(grown_afterwards, 0);
}

TEST(Tracker, TwoLockstepRunsAreIdenticalToTheBit) {
  Tracker a(testing::small_camera(), options(), Mapping::Lockstep, 1);
  Tracker b(testing::small_camera(), options(), Mapping::Lockstep, 1);
  const auto first = run(a, walk());
  const auto second = run(b, walk());
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].world_from_camera.has_value(), second[i].world_from_camera.has_value());
    if (!first[i].world_from_camera) continue;
    EXPECT_EQ(first[i].world_from_camera->translation, second[i].world_from_camera->translation);
    EXPECT_EQ(first[i].world_from_camera->rotation.coeffs(),
              second[i].world_from_camera->rotation.coeffs());
  }
}

TEST(Tracker, AThreadedMapperArrivesAtAMapToo) {
  Tracker tracker(testing::small_camera(), options(), Mapping::Threaded, 1);
  const auto frames = run(tracker, walk());
  tracker.finish();
  EXPECT_EQ(frames.back().state, TrackingState::Good);
  EXPECT_GE(tracker.statistics().keyframes, 2);
  EXPECT_TRUE(tracker.world_from_keyframe(frames.back().keyframe).has_value());
}

TEST(Tracker, AStillCameraIsToldToMove) {
  Tracker tracker(testing::small_camera(), options(), Mapping::Lockstep, 1);
  const std::vector<hal::Image> still(6, walk().front());
  for (const auto& f : run(tracker, still)) {
    EXPECT_EQ(f.state, TrackingState::Initialising);
    EXPECT_EQ(f.reason, TrackingReason::MoveSideways);
    EXPECT_FALSE(f.world_from_camera);
  }
}

TEST(Tracker, TurningOnlyMakesNoMap) {
  std::vector<hal::Image> images;
  for (int i = 0; i < 12; ++i) {
    const geometry::Pose pose(geometry::exp_so3(Eigen::Vector3d(0.0, 0.012 * i, 0.0)),
                              Eigen::Vector3d::Zero());
    images.push_back(testing::render_wedge(testing::small_camera(), pose));
  }
  Tracker tracker(testing::small_camera(), options(), Mapping::Lockstep, 1);
  const auto frames = run(tracker, images);
  for (const auto& f : frames) EXPECT_EQ(f.state, TrackingState::Initialising);
  EXPECT_EQ(frames.back().reason, TrackingReason::TurningOnly);
}

TEST(Tracker, ABlankPictureHasTooLittleTexture) {
  Tracker tracker(testing::small_camera(), options(), Mapping::Lockstep, 1);
  hal::Image wall(320, 240, 1);
  std::fill_n(wall.data(), wall.size_bytes(), std::uint8_t{180});
  const std::vector<hal::Image> blank(3, wall);
  for (const auto& f : run(tracker, blank)) {
    EXPECT_EQ(f.reason, TrackingReason::TooLittleTexture);
  }
}

TEST(Tracker, LosesACoveredLensAndComesBack) {
  std::vector<hal::Image> images = walk();
  images.insert(images.end(), 8, hal::Image(320, 240, 1));
  const std::size_t uncovered = images.size();
  images.push_back(walk()[22]);
  images.push_back(walk()[23]);
  Tracker tracker(testing::small_camera(), options(), Mapping::Lockstep, 1);
  const auto frames = run(tracker, images);
  EXPECT_EQ(frames[uncovered - 1].state, TrackingState::Lost);
  EXPECT_EQ(frames[uncovered - 1].reason, TrackingReason::TooDarkOrBlurred);
  EXPECT_FALSE(frames[uncovered - 1].world_from_camera);
  ASSERT_EQ(frames.back().state, TrackingState::Good);
  EXPECT_EQ(tracker.statistics().relocalisations, 1);
  EXPECT_LT(
      (frames.back().world_from_camera->translation - frames[23].world_from_camera->translation)
          .norm(),
      0.005);
}

// 40 degrees away from all that the map knows and back, without a step: the pose is held and
// turned, and not good enough to record with while the map does not show.
TEST(Tracker, TurningAwayAndBackKeepsThePose) {
  const geometry::Camera narrow = lumibox::testing::pinhole(320, 240, 480.0);
  std::vector<hal::Image> images = walk_sideways(narrow, 24, 0.015);
  const geometry::Pose last = walk_pose(23, 0.015);
  const auto turned = [&](int step) {
    return geometry::Pose(last.rotation * geometry::exp_so3({0.0, 0.035 * step, 0.0}),
                          last.translation);
  };
  std::vector<double> turns;
  for (int i = 1; i <= 40; ++i) {
    const int step = i <= 20 ? i : 40 - i;
    turns.push_back(0.035 * step);
    images.push_back(testing::render_wedge(narrow, turned(step)));
  }
  Tracker tracker(narrow, options(), Mapping::Lockstep, 1);
  const auto frames = run(tracker, images);
  const auto& before = *frames[23].world_from_camera;
  bool held = false;
  for (std::size_t i = 24; i < frames.size(); ++i) {
    ASSERT_TRUE(frames[i].world_from_camera) << i;
    held = held || frames[i].reason == TrackingReason::TurningOnly;
    // 0.02 rad: half a degree of turn and as much of place seen as turn, in a picture of 320
    // pixels.
    EXPECT_NEAR(frames[i].world_from_camera->rotation.angularDistance(before.rotation),
                turns[i - 24], 0.02)
        << i;
    EXPECT_LT((frames[i].world_from_camera->translation - before.translation).norm(), 0.05) << i;
  }
  EXPECT_TRUE(held) << "the map must be out of sight, or this tests nothing";
  EXPECT_EQ(frames.back().state, TrackingState::Good);
  EXPECT_EQ(tracker.statistics().relocalisations, 0);
}

/// The map after the first 16 frames of the walk.
std::shared_ptr<const MapView> map_of_first_half() {
  Tracker tracker(testing::small_camera(), options(), Mapping::Lockstep, 1);
  run(tracker, {walk().begin(), walk().begin() + 16});
  return tracker.map();
}

TEST(ResumedTracker, GoesOnAsIfNothingHadHappened) {
  Tracker uninterrupted(testing::small_camera(), options(), Mapping::Lockstep, 1);
  const auto expected = run(uninterrupted, walk());
  const auto saved = map_of_first_half();
  Tracker resumed(testing::small_camera(), options(), Mapping::Lockstep, 2, saved);
  for (std::size_t i = 13; i < walk().size(); ++i) {
    const auto frame = resumed.track(walk()[i], static_cast<std::int64_t>(i - 13), kPeriod);
    ASSERT_EQ(frame.state, TrackingState::Good) << i;
    // In the same world. 0.005 of the scene's depth: as after a loss, for the frames are found in a
    // map that grew with other keyframes.
    EXPECT_LT(
        (frame.world_from_camera->translation - expected[i].world_from_camera->translation).norm(),
        0.005)
        << i;
    EXPECT_LT(
        frame.world_from_camera->rotation.angularDistance(expected[i].world_from_camera->rotation),
        0.003)
        << i;
  }
  EXPECT_EQ(resumed.statistics().relocalisations, 1);
  ASSERT_GE(resumed.map()->keyframes.size(), saved->keyframes.size());
  for (std::size_t i = 0; i < saved->keyframes.size(); ++i) {
    EXPECT_EQ(resumed.map()->keyframes[i].pyramid, saved->keyframes[i].pyramid)
        << "keyframes keep their ids";
  }
}

// A walk along a part of the wall that the map has never seen: with enough parallax for a first
// map, if there were none.
TEST(ResumedTracker, StaysLostInAnotherPlaceUntilItIsToldToStartOver) {
  std::vector<hal::Image> elsewhere;
  for (int i = 0; i < 16; ++i) {
    geometry::Pose pose = walk_pose(i, 0.02);
    pose.translation.y() += 2.2;  // the map's pictures end 0.9 below the middle, these begin there
    elsewhere.push_back(testing::render_wedge(testing::small_camera(), pose));
  }
  for (const Mapping mapping : {Mapping::Lockstep, Mapping::Threaded}) {
    const auto saved = map_of_first_half();
    Tracker tracker(testing::small_camera(), options(), mapping, 2, saved);
    for (const TrackedFrame& frame : run(tracker, elsewhere)) {
      EXPECT_EQ(frame.state, TrackingState::Lost);
      EXPECT_EQ(frame.reason, TrackingReason::Relocalising);
      EXPECT_FALSE(frame.world_from_camera);
    }
    EXPECT_EQ(tracker.statistics().relocalisations, 0);
    EXPECT_EQ(tracker.map()->keyframes.size(), saved->keyframes.size());
    EXPECT_EQ(tracker.map()->points.size(), saved->points.size());
    tracker.start_over();
    EXPECT_EQ(tracker.map(), nullptr);
    const auto frames = run(tracker, elsewhere);
    EXPECT_EQ(frames.front().state, TrackingState::Initialising);
    EXPECT_EQ(frames.back().state, TrackingState::Good) << "or the pictures show nothing";
  }
}

TEST(Tracker, EveryReasonHasItsAdvice) {
  EXPECT_STREQ(advice(TrackingReason::None), "");
  for (const auto reason :
       {TrackingReason::TooLittleTexture, TrackingReason::MoveSideways, TrackingReason::TurningOnly,
        TrackingReason::PlaneAmbiguous, TrackingReason::TooDarkOrBlurred,
        TrackingReason::TooFewPointsFound, TrackingReason::Relocalising}) {
    EXPECT_STRNE(advice(reason), "");
  }
}

}  // namespace
}  // namespace lumibox::tracking
