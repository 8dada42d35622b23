#include "app/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "app/moments.h"
#include "app/saved_capture.h"
#include "config/error.h"
#include "lightfield/capture.h"
#include "lightfield/map_files.h"
#include "support/input_error.h"
#include "support/temp_dir.h"

namespace lumibox::app {
namespace {

using testing::around_subject;

constexpr double kDegree = std::numbers::pi / 180.0;
const lightfield::Sphere kSphere{Eigen::Vector3d::UnitZ(), 0.3};

class RecorderTest : public ::testing::Test {
 protected:
  void begin() { recorder_.begin(kSphere, world_.see_from({}), dir_ / "capture"); }
  void record(double angle) { recorder_.record(world_.see_from(around_subject(angle))); }
  const lightfield::LightField& light_field() const { return recorder_.light_field(); }

  testing::TempDir dir_;
  testing::World world_;
  Recorder recorder_{testing::small_camera(), config::Capture{}, lightfield::Writing::Inline};
};

TEST_F(RecorderTest, GateAcceptsOnlyWhatIsFarEnoughFromAllRecorded) {
  begin();
  record(0.0);
  record(10.0 * kDegree);
  const auto accepts = [&](double degrees) {
    return recorder_.accepts(world_.see_from(around_subject(degrees * kDegree)), 4.0 * kDegree);
  };
  EXPECT_FALSE(accepts(3.9));
  EXPECT_TRUE(accepts(4.1));
  EXPECT_FALSE(accepts(6.1));
  EXPECT_TRUE(accepts(14.1));
}

TEST_F(RecorderTest, NothingIsAcceptedFromAPoorOrAnOldFrame) {
  begin();
  Moment moment = world_.see_from(around_subject(0.5));
  EXPECT_TRUE(recorder_.accepts(moment, kDegree));
  moment.fresh = false;
  EXPECT_FALSE(recorder_.accepts(moment, kDegree));
  moment.fresh = true;
  moment.tracked.state = tracking::TrackingState::Poor;
  EXPECT_FALSE(recorder_.accepts(moment, kDegree));
}

TEST_F(RecorderTest, WhatIsInMemoryIsOnDisk) {
  begin();
  EXPECT_FALSE(std::filesystem::exists(dir_ / "capture")) << "nothing recorded yet";
  record(0.0);
  record(0.2);
  record(0.4);
  ASSERT_TRUE(recorder_.wipe_nearest(around_subject(0.21).translation));
  auto capture = lightfield::load_capture(dir_ / "capture");
  EXPECT_EQ(capture.light_field.perspectives().size(), 2U);
  ASSERT_TRUE(recorder_.undo_wipe());
  EXPECT_FALSE(recorder_.undo_wipe());
  capture = lightfield::load_capture(dir_ / "capture");
  ASSERT_EQ(capture.light_field.perspectives().size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(capture.light_field.perspectives()[i].center().isApprox(
        light_field().perspectives()[i].center(), 1e-9));
  }
}

TEST_F(RecorderTest, CorrectionOfTheMapMovesPerspectivesAndSubject) {
  begin();
  record(0.2);
  const Eigen::Vector3d shift(0.1, -0.2, 0.3);
  world_.move_keyframe(0, {Eigen::Quaterniond::Identity(), shift});
  recorder_.follow_map(world_.map(), 0.002);
  const Eigen::Vector3d expected = around_subject(0.2).translation + shift;
  EXPECT_TRUE(light_field().perspectives().front().center().isApprox(expected, 1e-12));
  EXPECT_TRUE(light_field().subject()->center.isApprox(kSphere.center + shift, 1e-12));
}

TEST_F(RecorderTest, CorrectionsTooSmallToSeeAreLeftForLater) {
  begin();
  record(0.2);
  const Eigen::Vector3d before = light_field().perspectives().front().center();
  for (int i = 1; i <= 5; ++i) {
    world_.move_keyframe(0, {Eigen::Quaterniond::Identity(), {0.001 * i, 0.0, 0.0}});
    recorder_.follow_map(world_.map(), 0.0035);
    const double moved = (light_field().perspectives().front().center() - before).norm();
    EXPECT_NEAR(moved, i < 4 ? 0.0 : 0.004, 1e-12) << i;
  }
}

TEST_F(RecorderTest, PerspectiveThatWasWipedDuringACorrectionComesBackCorrected) {
  begin();
  record(0.0);
  record(0.2);
  recorder_.wipe_nearest(around_subject(0.2).translation);
  world_.move_keyframe(0, {Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0}});
  recorder_.follow_map(world_.map(), 0.002);
  recorder_.undo_wipe();
  recorder_.follow_map(world_.map(), 0.002);
  EXPECT_TRUE(light_field().perspectives().back().center().isApprox(
      around_subject(0.2).translation + Eigen::Vector3d::UnitX(), 1e-12));
}

TEST_F(RecorderTest, FolderThatCannotBeMadeIsAnErrorToShowAndRecordingGoesOn) {
  dir_.write("file", "in the way");
  recorder_.begin(kSphere, world_.see_from({}), dir_ / "file" / "capture");
  record(0.0);
  record(0.2);
  EXPECT_EQ(light_field().perspectives().size(), 2U);
  ASSERT_TRUE(recorder_.error());
  EXPECT_NE(recorder_.error()->find((dir_ / "file").string()), std::string::npos);
}

TEST_F(RecorderTest, NewCaptureLeavesTheOneBeforeComplete) {
  EXPECT_EQ(next_capture_folder(dir_.path()), dir_ / "capture-0001");
  recorder_.begin(kSphere, world_.see_from({}), next_capture_folder(dir_.path()));
  record(0.0);
  EXPECT_EQ(next_capture_folder(dir_.path()), dir_ / "capture-0002");
  recorder_.begin(kSphere, world_.see_from({}), next_capture_folder(dir_.path()));
  EXPECT_TRUE(light_field().perspectives().empty());
  const auto first = lightfield::load_capture(dir_ / "capture-0001");
  EXPECT_EQ(first.light_field.perspectives().size(), 1U);
  EXPECT_EQ(first.points, world_.map().points());
}

TEST_F(RecorderTest, CaptureThatEndsIsWhereTheMapIsToTheLastBit) {
  recorder_.begin(kSphere, world_.see_from({}), dir_ / "capture-0001");
  record(0.0);
  const Eigen::Vector3d little(0.001, 0.0, 0.0);
  world_.move_keyframe(0, {Eigen::Quaterniond::Identity(), little});
  recorder_.follow_map(world_.map(), 0.01);
  EXPECT_EQ(light_field().perspectives().front().center().norm(), 0.0);
  recorder_.begin(kSphere, world_.see_from({}), dir_ / "capture-0002");
  const auto first = lightfield::load_capture(dir_ / "capture-0001");
  EXPECT_TRUE(first.light_field.perspectives().front().center().isApprox(little, 1e-12));
  EXPECT_TRUE(first.light_field.subject()->center.isApprox(kSphere.center + little, 1e-12));
}

TEST_F(RecorderTest, ErrorInTheLastWriteOfTheCaptureBeforeIsShownAndNotForgotten) {
  recorder_.begin(kSphere, world_.see_from({}), dir_ / "capture-0001");
  record(0.0);
  std::filesystem::remove_all(dir_ / "capture-0001");
  EXPECT_FALSE(recorder_.error());
  for (const char* next : {"capture-0002", "capture-0003"}) {
    recorder_.begin(kSphere, world_.see_from({}), dir_ / next);
    record(0.0);
    ASSERT_TRUE(recorder_.error());
    EXPECT_THAT(*recorder_.error(), ::testing::HasSubstr("capture-0001"));
  }
  EXPECT_THROW(recorder_.finish(world_.map()), config::InputError);
  EXPECT_EQ(lightfield::load_capture(dir_ / "capture-0002").points.size(), 1U);
  EXPECT_EQ(lightfield::load_capture(dir_ / "capture-0003").points.size(), 1U);
}

// The live pose was off by as much as the map was then; in the end the points tell better.
TEST_F(RecorderTest, CaptureThatEndsHasItsPosesFromThePointsAsTheyAreInTheEnd) {
  begin();
  const geometry::Camera camera = testing::small_camera();
  auto map = std::make_shared<tracking::MapView>(*world_.copy());
  tracking::FrameMeasurements measured;
  const geometry::Pose truth = around_subject(0.2);
  for (int i = 0; i < 64; ++i) {
    const Eigen::Vector3d point(0.08 * (i % 8) - 0.3, 0.06 * (i / 8) - 0.2, 0.8 + 0.05 * (i % 5));
    map->points.push_back({i, point, 0, 0});
    measured.points.push_back(
        {i, camera.project(truth.inverse() * point).value().cast<float>(), 0});
  }
  Moment moment = world_.see_from(around_subject(0.21));
  moment.measurements = &measured;
  recorder_.record(moment);
  MapNow end = world_.map();
  end.copy = [map] { return map; };
  recorder_.finish(end);
  const auto capture = lightfield::load_capture(dir_ / "capture");
  const auto& perspective = capture.light_field.perspectives().front();
  // 1e-5: pixels are floats, and the picture is small.
  EXPECT_LT((perspective.center() - truth.translation).norm(), 1e-5);
  EXPECT_LT((perspective.keyframe_from_camera.translation - truth.translation).norm(), 1e-5)
      << "keyframe 0 is the world: what the capture is gone on with from is refined, too";
}

/// A capture that the power left, and the box that finds it.
class ResumedRecorder : public RecorderTest {
 protected:
  ResumedRecorder() {
    world_.move_keyframe(1, {Eigen::Quaterniond::Identity(), {0.5, 0.0, 0.0}});
    recorder_.begin(kSphere, world_.see_from({}), dir_ / "capture-0001");
    recorder_.set_threshold(0.1);
  }

  /// Hangs on keyframe `id`.
  void record_on(tracking::KeyframeId id, double angle) {
    Moment moment = world_.see_from(around_subject(angle));
    moment.tracked.keyframe = id;
    moment.tracked.keyframe_from_camera =
        world_.map().world_from_keyframe(id)->inverse() * around_subject(angle);
    recorder_.record(moment);
  }

  SavedCapture saved() const {
    return load_saved_capture(dir_ / "capture-0001", testing::small_camera(), 2);
  }

  /// What the power leaves is what is on disk while the recorder before still lives.
  void resume() { resumed_.resume(saved().capture, &(map_ = world_.map())); }

  MapNow map_;
  Recorder resumed_{testing::small_camera(), config::Capture{}, lightfield::Writing::Inline};
};

TEST_F(ResumedRecorder, GoesOnInTheSameWorldWithSphereThresholdAndAllPerspectives) {
  record_on(0, 0.0);
  record_on(1, 0.3);
  recorder_.keep_map(world_.see_from({}));
  record_on(1, 0.6);
  EXPECT_EQ(saved().problem, "");
  EXPECT_NEAR(*saved().capture.threshold, 0.1, 1e-12);
  resume();
  ASSERT_EQ(resumed_.light_field().perspectives().size(), 3U);
  EXPECT_EQ(resumed_.light_field().subject()->center, kSphere.center);
  const Eigen::Vector3d shift(0.0, 0.1, 0.0);
  world_.move_keyframe(1, {Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.5, 0.0, 0.0) + shift});
  resumed_.follow_map(world_.map(), 0.0);
  const auto& perspectives = resumed_.light_field().perspectives();
  EXPECT_TRUE(perspectives[0].center().isApprox(around_subject(0.0).translation, 1e-12));
  EXPECT_TRUE(perspectives[2].center().isApprox(around_subject(0.6).translation + shift, 1e-12));
  resumed_.record(world_.see_from(around_subject(0.9)));
  resumed_.finish(world_.map());
  const auto capture = lightfield::load_capture(dir_ / "capture-0001");
  ASSERT_EQ(capture.light_field.perspectives().size(), 4U);
  EXPECT_EQ(capture.light_field.perspectives()[3].id, 3);
  EXPECT_TRUE(capture.light_field.perspectives()[1].center().isApprox(
      around_subject(0.3).translation + shift, 1e-9));
}

// The sphere too hangs on its keyframe after the power was gone.
TEST_F(ResumedRecorder, SphereFollowsItsKeyframe) {
  record_on(0, 0.0);
  recorder_.keep_map(world_.see_from({}));
  resume();
  const Eigen::Vector3d shift(0.2, 0.1, 0.0);
  world_.move_keyframe(0, {Eigen::Quaterniond::Identity(), shift});
  resumed_.follow_map(world_.map(), 0.0);
  EXPECT_TRUE(resumed_.light_field().subject()->center.isApprox(kSphere.center + shift, 1e-12));
}

// Keyframe 2 came after the map was kept: it went with the power, and the next one to be made will
// have its number.
TEST_F(ResumedRecorder, WhatHungOnAKeyframeThatWentWithThePowerHangsOnTheNearest) {
  record_on(0, 0.0);
  recorder_.keep_map(world_.see_from({}));
  testing::World later = world_;
  later.move_keyframe(2, {Eigen::Quaterniond::Identity(), {0.1, 0.2, 0.3}});
  std::swap(world_, later);
  record_on(2, 0.4);
  std::swap(world_, later);
  resume();
  const auto& perspective = resumed_.light_field().perspectives()[1];
  EXPECT_LT(perspective.keyframe, 2);
  const auto keyframe = *world_.map().world_from_keyframe(perspective.keyframe);
  EXPECT_TRUE((keyframe * perspective.keyframe_from_camera)
                  .translation.isApprox(around_subject(0.4).translation, 1e-9));
  world_.move_keyframe(2, {Eigen::Quaterniond::Identity(), {7.0, 8.0, 9.0}});
  resumed_.follow_map(world_.map(), 0.0);
  EXPECT_TRUE(resumed_.light_field().perspectives()[1].center().isApprox(
      around_subject(0.4).translation, 1e-9));
}

TEST_F(ResumedRecorder, WithoutAMapItIsShownAndNeverMoved) {
  record_on(0, 0.0);
  record_on(1, 0.3);
  EXPECT_THAT(saved().problem, ::testing::HasSubstr((dir_ / "capture-0001/map/map.json").string()));
  resumed_.resume(saved().capture, nullptr);
  testing::World other;
  other.move_keyframe(0, {Eigen::Quaterniond::Identity(), {7.0, 8.0, 9.0}});
  resumed_.follow_map(other.map(), 0.0);
  resumed_.keep_map(other.see_from({}));
  EXPECT_TRUE(resumed_.wipe_nearest(around_subject(0.3).translation));
  resumed_.finish(other.map());
  const auto capture = lightfield::load_capture(dir_ / "capture-0001");
  ASSERT_EQ(capture.light_field.perspectives().size(), 1U);
  EXPECT_TRUE(capture.light_field.perspectives()[0].center().isApprox(
      around_subject(0.0).translation, 1e-9));
  EXPECT_TRUE(capture.points.empty());
  EXPECT_FALSE(std::filesystem::exists(dir_ / "capture-0001/map"));
}

TEST_F(ResumedRecorder, MapIsKeptWhenItHasChangedAndSomeTimeIsOver) {
  const auto kept = [this] {
    return lightfield::read_map(dir_ / "capture-0001", testing::small_camera(), 2).keyframes.size();
  };
  const auto see_at = [this](double seconds) {
    Moment moment = world_.see_from({});
    moment.frame.timestamp_ns = static_cast<std::int64_t>(1e9 * seconds);
    recorder_.keep_map(moment);
  };
  record_on(0, 0.0);
  see_at(1.0);
  EXPECT_EQ(kept(), 2U) << "at once, the first time";
  world_.move_keyframe(2, {});
  see_at(5.9);
  EXPECT_EQ(kept(), 2U);
  see_at(6.1);
  EXPECT_EQ(kept(), 3U);
  world_.move_keyframe(3, {});
  recorder_.finish(world_.map());
  EXPECT_EQ(kept(), 4U) << "at the end, however soon";
}

}  // namespace
}  // namespace lumibox::app
