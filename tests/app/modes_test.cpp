#include "app/modes/modes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>
#include <optional>

#include "app/moments.h"
#include "lightfield/capture.h"
#include "support/temp_dir.h"

namespace lumibox::app {
namespace {

using hal::Button;
using testing::around_subject;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr Gesture kMain{Button::Main, Press::Short};
constexpr Gesture kMainLong{Button::Main, Press::Long};
constexpr Gesture kReview{Button::Review, Press::Short};
constexpr Gesture kReviewLong{Button::Review, Press::Long};
constexpr Gesture kPlus{Button::Plus, Press::Short};
constexpr Gesture kPlusLong{Button::Plus, Press::Long};
constexpr Gesture kMinus{Button::Minus, Press::Short};
constexpr Gesture kWipe{Button::Wipe, Press::Short};
constexpr Gesture kWipeLong{Button::Wipe, Press::Long};

/// A box in the hand of the test.
struct Box {
  testing::TempDir dir;
  testing::World world;
  config::Config config;
  Recorder recorder{testing::small_camera(), config.capture, lightfield::Writing::Inline};
  Session session{config, dir.path(), recorder, config.capture.threshold_deg* kDegree};
  Modes modes{session, testing::small_camera()};

  /// One tick as the loop has it, at an angle around the subject.
  Decision tick(const std::vector<Gesture>& gestures = {}, double angle = 0.0) {
    return tick_with(gestures, world.see_from(around_subject(angle)));
  }
  Decision tick_with(const std::vector<Gesture>& gestures, const Moment& moment) {
    recorder.follow_map(moment.map, config.capture.moved_share);
    const Decision decision = modes.decide(gestures, moment);
    if (decision.record) {
      recorder.record(moment);
    }
    picture = modes.draw(moment);
    return decision;
  }
  void go_to_capture() {
    tick();
    tick({kMain});
    tick({kMain});
  }
  /// From the subject's side to side, recording.
  void walk() {
    for (int i = -20; i <= 20; ++i) {
      tick({}, i * 1.5 * kDegree);
    }
  }
  std::size_t views() const { return recorder.light_field().perspectives().size(); }

  Picture picture;
};

TEST(Acquire, WaitsWithAdviceAndGoesOnByItself) {
  Box box;
  Moment moment = box.world.see_nothing(tracking::TrackingReason::MoveSideways);
  moment.tracked.state = tracking::TrackingState::Initialising;
  box.tick_with({kMain, kReview, kPlus, kWipe, kMainLong}, moment);
  EXPECT_EQ(box.modes.current(), ModeId::Acquire);
  EXPECT_EQ(box.picture.advice, tracking::advice(tracking::TrackingReason::MoveSideways));
  box.tick();
  EXPECT_EQ(box.modes.current(), ModeId::Subject);
}

TEST(Subject, SphereFollowsTheReticleUntilItIsPlaced) {
  Box box;
  box.tick();
  box.tick({}, 0.3);
  ASSERT_TRUE(box.picture.coverage);
  EXPECT_TRUE(box.picture.reticle);
  EXPECT_TRUE(box.picture.coverage->sphere.center.isApprox(Eigen::Vector3d::UnitZ(), 1e-2));
  box.tick_with({}, box.world.see_from({Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0}}));
  EXPECT_NEAR(box.picture.coverage->sphere.center.x(), 1.0, 1e-2);
  box.tick({kMain});
  EXPECT_FALSE(box.picture.reticle);
  const Eigen::Vector3d placed = box.picture.coverage->sphere.center;
  box.tick({}, 0.5);
  EXPECT_EQ(box.picture.coverage->sphere.center, placed);
}

// Whoever adjusts first must not find the capture begun by the Main that was meant to place.
TEST(Subject, PlusAndMinusSlideTheSphereThatFollowsTheReticleAndOnlyMainPlacesIt) {
  Box box;
  box.tick();
  const Eigen::Vector3d seen = box.picture.coverage->sphere.center;
  box.tick({kPlus});
  const Eigen::Vector3d farther = box.picture.coverage->sphere.center;
  EXPECT_GT(farther.z(), seen.z());
  EXPECT_TRUE(box.picture.reticle);
  EXPECT_EQ(box.picture.title, "aim at the subject");
  box.tick_with({}, box.world.see_from({Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0}}));
  EXPECT_NEAR(box.picture.coverage->sphere.center.x(), 1.0, 1e-2);
  EXPECT_NEAR(box.picture.coverage->sphere.center.z(), farther.z(), 1e-2) << "still farther";
  box.tick({kMain});
  EXPECT_EQ(box.modes.current(), ModeId::Subject);
  EXPECT_FALSE(box.picture.reticle);
  EXPECT_EQ(box.picture.title, "the sphere is placed");
  EXPECT_FALSE(box.recorder.light_field().subject());
  box.tick({kMain});
  EXPECT_EQ(box.modes.current(), ModeId::Capture);
}

TEST(Subject, WhatIsNotSeenIsNotSlid) {
  Box box;
  Moment nothing_there = box.world.see_from({});
  nothing_there.map_points.clear();
  box.tick_with({}, nothing_there);
  box.tick_with({kPlus, kPlusLong}, nothing_there);
  box.tick();
  EXPECT_NEAR(box.picture.coverage->sphere.center.z(), 1.0, 1e-2);
}

TEST(Subject, PlusAndMinusSlideThePlacedSphereAlongTheRayFixedInTheWorld) {
  Box box;
  box.tick();
  box.tick({kMain});
  const Eigen::Vector3d first = box.picture.coverage->sphere.center;
  box.tick({kPlus});
  const Eigen::Vector3d farther = box.picture.coverage->sphere.center;
  EXPECT_GT(farther.z(), first.z());
  EXPECT_NEAR(farther.x(), first.x(), 1e-9);
  box.tick({kPlusLong}, 0.4);
  EXPECT_GT(box.picture.coverage->sphere.center.z(), farther.z());
  EXPECT_NEAR(box.picture.coverage->sphere.center.x(), first.x(), 1e-9);
  box.tick({kMinus, kMinus, kMinus, kMinus, kMinus, kMinus});
  EXPECT_TRUE(box.picture.coverage->sphere.center.isApprox(first, 1e-9));
}

TEST(Subject, WipeTakesThePlacementBack) {
  Box box;
  box.tick();
  box.tick({kMain});
  box.tick({kWipe});
  EXPECT_TRUE(box.picture.reticle);
  EXPECT_EQ(box.modes.current(), ModeId::Subject);
}

TEST(Subject, AugmentedApertureCollectsAFewPicturesAndPutsTheSphereAtItsFocus) {
  Box box;
  box.tick();
  box.tick({kReview});
  for (int i = 0; i < 100; ++i) {
    box.tick({}, 3.0 * kDegree * std::sin(0.2 * i));
  }
  ASSERT_TRUE(box.picture.light_field);
  const LightFieldPicture fused = *box.picture.light_field;
  EXPECT_GT(fused.perspectives.size(), 5U);
  EXPECT_LE(fused.perspectives.size(), static_cast<std::size_t>(box.config.aperture.frames) + 1U);
  EXPECT_EQ(fused.settings.aperture, render::Aperture::Wide);
  EXPECT_EQ(fused.settings.exponent, 0.0);
  EXPECT_GE(fused.settings.k, static_cast<int>(fused.perspectives.size()));
  EXPECT_EQ(box.views(), 0U) << "those pictures are not part of the light field";

  box.tick({kPlus, kPlus, kPlus});
  const Eigen::Vector3d focus = box.picture.light_field->settings.focus;
  EXPECT_GT(focus.z(), fused.settings.focus.z());
  box.tick({kMain});
  ASSERT_TRUE(box.picture.coverage);
  EXPECT_FALSE(box.picture.light_field);
  EXPECT_TRUE(box.picture.coverage->sphere.center.isApprox(focus, 1e-9));
  box.tick({kMain});
  EXPECT_EQ(box.modes.current(), ModeId::Capture);
  EXPECT_TRUE(box.recorder.light_field().subject()->center.isApprox(focus, 1e-9));
}

TEST(Subject, AugmentedApertureShowsAFrameAsOneAndTheSamePhotoWhileItIsTheNewest) {
  Box box;
  box.tick();
  box.tick({kReview});
  const auto live = [&box] { return box.picture.light_field->perspectives.back().photo; };
  Moment moment = box.world.see_from({});
  box.tick_with({}, moment);
  const auto first = live();
  EXPECT_EQ(first->rgb(), moment.frame.color);
  moment.fresh = false;
  box.tick_with({}, moment);
  EXPECT_EQ(live(), first);
  box.tick();
  EXPECT_NE(live(), first);
}

TEST(Subject, WithoutAnyPointsThereIsNoSphereAndMainDoesNothing) {
  Box box;
  Moment moment = box.world.see_from({});
  moment.map_points.clear();
  box.tick_with({}, moment);
  box.tick_with({kMain, kMain, kReview, kMain, kMain}, moment);
  EXPECT_EQ(box.modes.current(), ModeId::Subject);
  EXPECT_FALSE(box.picture.coverage);
}

TEST(Capture, RecordsOnTheWayByItselfAndOnlyWhenTheGateAccepts) {
  Box box;
  box.go_to_capture();
  box.walk();
  EXPECT_EQ(box.modes.current(), ModeId::Capture);
  EXPECT_GT(box.views(), 10U);
  const std::size_t first = box.views();
  box.walk();
  EXPECT_EQ(box.views(), first) << "the same way again has nothing new";
  EXPECT_EQ(box.picture.coverage->recorded.size(), first);
  EXPECT_TRUE(box.tick().hold_exposure);
}

TEST(Capture, SaysThatItIsRecordingUnlessPausedAndNoOtherModeDoes) {
  Box box;
  EXPECT_FALSE(box.tick().recording);
  box.go_to_capture();
  EXPECT_TRUE(box.tick().recording);
  EXPECT_FALSE(box.tick({kMain}).recording);
  EXPECT_TRUE(box.tick({kMain}).recording);
  EXPECT_FALSE(box.tick({kReview}).recording);
}

TEST(Capture, SmallerThresholdRecordsMore) {
  Box box;
  box.go_to_capture();
  box.walk();
  const std::size_t first = box.views();
  const double before = box.session.threshold;
  box.tick({kMinus});
  EXPECT_NEAR(box.session.threshold, before / box.config.capture.threshold_step, 1e-12);
  box.tick({{Button::Minus, Press::Long}});
  box.walk();
  EXPECT_GT(box.views(), first);
  for (int i = 0; i < 100; ++i) {
    box.tick({kPlusLong});
  }
  EXPECT_NEAR(box.session.threshold, box.config.capture.threshold_max_deg * kDegree, 1e-12);
}

TEST(Capture, MainPausesAndWipePausesToo) {
  Box box;
  box.go_to_capture();
  box.tick({kMain});
  const std::size_t paused = box.views();
  box.walk();
  EXPECT_EQ(box.views(), paused);
  EXPECT_THAT(box.picture.title, HasSubstr("paused"));
  box.tick({kMain});
  box.walk();
  EXPECT_GT(box.views(), paused);
  const std::size_t recorded = box.views();
  box.tick({kWipe});
  box.tick();
  EXPECT_EQ(box.views(), recorded - 1) << "and the same view is not taken again at once";
  box.tick({kWipeLong});
  EXPECT_EQ(box.views(), recorded);
}

TEST(Capture, LongMainIsForTheNextSubjectAndNothingRecordedIsLost) {
  Box box;
  box.go_to_capture();
  box.walk();
  const std::size_t recorded = box.views();
  box.tick({kMainLong});
  EXPECT_EQ(box.modes.current(), ModeId::Subject);
  box.tick({kWipe});
  EXPECT_EQ(box.modes.current(), ModeId::Capture) << "changed one's mind";
  EXPECT_EQ(box.views(), recorded);
  box.tick({kMainLong});
  box.tick({kMain});
  box.tick({kMain}, 0.1);
  EXPECT_EQ(box.modes.current(), ModeId::Capture);
  EXPECT_LE(box.views(), 1U);
  EXPECT_TRUE(std::filesystem::exists(box.dir / "capture-0001" / "transforms.json"));
}

TEST(Capture, LossIsSaidAndNothingIsRecorded) {
  Box box;
  box.go_to_capture();
  const std::size_t recorded = box.views();
  box.tick_with({kWipe}, box.world.see_nothing(tracking::TrackingReason::Relocalising));
  EXPECT_EQ(box.views(), recorded);
  EXPECT_EQ(box.picture.advice, tracking::advice(tracking::TrackingReason::Relocalising));
  EXPECT_FALSE(box.picture.coverage);
}

TEST(Capture, SaysTheGhostingThatTheGateLeaves) {
  Box box;
  box.go_to_capture();
  box.walk();
  box.tick({}, 0.1);
  // f = 60, a sphere of 0.35 of the distance, 4 degrees: 60 * 0.0698 * 0.35 / 0.8775 = 1.67.
  EXPECT_THAT(box.picture.title, HasSubstr("gate 4.0\u00b0  ghosting 2 px"));
  for (int i = 0; i < 10; ++i) {
    box.tick({kPlus}, 0.1);
  }
  EXPECT_THAT(box.picture.title, HasSubstr("ghosting 13 px"));
  box.tick_with({}, box.world.see_nothing(tracking::TrackingReason::Relocalising));
  EXPECT_THAT(box.picture.title, Not(HasSubstr("ghosting"))) << "nobody knows the distance";
}

TEST(Capture, PointsToTheHoleUntilItIsFilled) {
  Box box;
  box.go_to_capture();
  box.walk();
  EXPECT_EQ(box.picture.details, "") << "a walk without holes";
  EXPECT_FALSE(box.picture.way);
  EXPECT_FALSE(box.picture.coverage->hole);
  for (int i = 0; i < 8; ++i) {
    box.tick({kWipe});  // and recording pauses
  }
  box.tick({}, -25.0 * kDegree);
  EXPECT_THAT(box.picture.details, HasSubstr("missing"));
  ASSERT_TRUE(box.picture.way);
  EXPECT_LT(box.picture.way->x(), -0.9) << "around_subject() goes to the left";
  ASSERT_TRUE(box.picture.coverage->hole);
  box.tick({}, 25.0 * kDegree);
  EXPECT_GT(box.picture.way->x(), 0.9);
  box.tick({}, 0.0);
  EXPECT_FALSE(box.picture.way) << "it is there";
  box.tick({kMain});
  box.walk();
  box.tick();
  EXPECT_EQ(box.picture.details, "");
  EXPECT_FALSE(box.picture.coverage->hole);
}

TEST(Capture, DotsHaveTheirQualityAsFarAsItIsKnown) {
  Box box;
  box.go_to_capture();
  box.walk();
  box.session.quality = {{{0, 31.0}, {2, 17.0}}, {2}, 24.0, {}};
  box.tick();
  const auto& dots = box.picture.coverage->recorded;
  EXPECT_EQ(dots[0].psnr, 31.0);
  EXPECT_FALSE(dots[0].disagrees);
  EXPECT_FALSE(dots[1].psnr);
  EXPECT_EQ(dots[2].psnr, 17.0);
  EXPECT_TRUE(dots[2].disagrees);
  EXPECT_THAT(box.picture.details, HasSubstr("likeness 24.0 dB of 2"));
}

TEST(Review, IsThereInTheSameTickAndShowsAllThatIsRecorded) {
  Box box;
  box.go_to_capture();
  box.walk();
  box.tick({kReview}, 0.1);
  ASSERT_TRUE(box.picture.light_field);
  EXPECT_EQ(box.picture.light_field->perspectives.size(), box.views());
  EXPECT_EQ(box.picture.light_field->settings.aperture, render::Aperture::Small);
  EXPECT_TRUE(box.picture.light_field->settings.focus.isApprox(
      box.recorder.light_field().subject()->center, 1e-9));
  EXPECT_EQ(box.picture.world_from_view->translation, around_subject(0.1).translation);
  const std::size_t recorded = box.views();
  box.tick({}, 2.0);
  EXPECT_EQ(box.views(), recorded) << "review does not record";
  box.tick({kReview});
  EXPECT_EQ(box.modes.current(), ModeId::Capture);
}

TEST(Review, MainChangesTheApertureAndPlusMinusTheFocus) {
  Box box;
  box.go_to_capture();
  box.walk();
  box.tick({kReview});
  const Eigen::Vector3d subject = box.picture.light_field->settings.focus;
  box.tick({kMain, kPlus});
  EXPECT_EQ(box.picture.light_field->settings.aperture, render::Aperture::Wide);
  EXPECT_GT(box.picture.light_field->settings.focus.z(), subject.z());
  box.tick({kMinus, kMinus});
  EXPECT_LT(box.picture.light_field->settings.focus.z(), subject.z());
  box.tick({kReview});
  box.tick({kReview});
  EXPECT_TRUE(box.picture.light_field->settings.focus.isApprox(subject, 1e-9));
}

/// What a box sees of a wall with a pattern, 1.3 before the world's origin.
Moment before_a_wall(Box& box, double angle) {
  Moment moment = box.world.see_from(around_subject(angle));
  const geometry::Camera camera = testing::small_camera();
  hal::Image image(64, 48, 3);
  const geometry::Pose& pose = *moment.tracked.world_from_camera;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Eigen::Vector3d ray = pose.rotation * camera.unproject({x, y})->homogeneous();
      const Eigen::Vector3d p = pose.translation + (1.3 - pose.translation.z()) / ray.z() * ray;
      const double value = 128.0 + 60.0 * std::sin(45.0 * p.x()) + 60.0 * std::sin(50.0 * p.y());
      std::fill_n(image.at(x, y), 3, static_cast<std::uint8_t>(value));
    }
  }
  moment.frame.color = std::make_shared<hal::Image>(std::move(image));
  return moment;
}

TEST(Review, TheWideApertureFocusesOnWhatIsUnderTheReticleAndStaysThere) {
  Box box;
  box.go_to_capture();
  for (int i = -20; i <= 20; ++i) {
    box.tick_with({}, before_a_wall(box, i * 1.5 * kDegree));
  }
  box.tick({kReview});
  const Eigen::Vector3d subject = box.recorder.light_field().subject()->center;
  EXPECT_FALSE(box.picture.reticle);
  EXPECT_TRUE(box.picture.light_field->settings.focus.isApprox(subject, 1e-9));

  box.tick({kMain});
  EXPECT_TRUE(box.picture.reticle);
  const Eigen::Vector3d focus = box.picture.light_field->settings.focus;
  EXPECT_NEAR(1.0 / focus.z(), 1.0 / 1.3, 0.025) << "half a step of the sweep";
  EXPECT_NEAR(focus.head<2>().norm(), 0.0, 0.03) << "on the line of sight";
  box.tick({}, 0.3);
  EXPECT_EQ(box.picture.light_field->settings.focus, focus) << "in world, wherever the view is";
  box.tick({kPlus});
  EXPECT_GT(box.picture.light_field->settings.focus.z(), focus.z()) << "by hand, from there";

  box.tick({kMain});
  EXPECT_FALSE(box.picture.reticle);
  EXPECT_TRUE(box.picture.light_field->settings.focus.isApprox(subject, 1e-9));
  box.tick({}, 0.3);
  box.tick({kMain}, 0.3);
  const Eigen::Vector3d anew = box.picture.light_field->settings.focus;
  EXPECT_NEAR(anew.z(), 1.3, 0.05);
  EXPECT_GT((anew - focus).norm(), 0.05) << "under the reticle of another view";
}

TEST(Review, ShowsPicturesWithTheGainsThatAreKnown) {
  Box box;
  box.go_to_capture();
  box.walk();
  box.session.quality.gains = {{1, 1.5}, {4, 0.5}};
  box.tick({kReview});
  const auto& shown = box.picture.light_field->perspectives;
  EXPECT_EQ(shown[1].gain, 1.5);
  EXPECT_EQ(shown[2].gain, 1.0);
  EXPECT_EQ(shown[4].gain, 0.5);
}

TEST(Review, WipeRemovesTheViewNearestToTheVirtualCameraAndUndoBringsItBack) {
  Box box;
  box.go_to_capture();
  box.walk();
  box.tick({kReview}, 0.2);
  const std::size_t recorded = box.views();
  const auto& light_field = box.recorder.light_field();
  const int nearest = light_field.nearest(around_subject(0.2).translation).value();
  box.tick({kWipe}, 0.2);
  EXPECT_EQ(box.views(), recorded - 1);
  EXPECT_NE(light_field.nearest(around_subject(0.2).translation).value(), nearest);
  box.tick({kWipeLong}, 0.2);
  EXPECT_EQ(light_field.nearest(around_subject(0.2).translation).value(), nearest);
}

TEST(Review, OrbitTurnsByItselfAndNeedsNoTracking) {
  Box box;
  box.go_to_capture();
  box.walk();
  box.tick({kReview});
  const auto lost = [&] { return box.world.see_nothing(tracking::TrackingReason::Relocalising); };
  box.tick_with({kMainLong}, lost());
  const geometry::Pose first = *box.picture.world_from_view;
  for (int i = 0; i < 30; ++i) {
    box.tick_with({}, lost());
  }
  EXPECT_GT((box.picture.world_from_view->translation - first.translation).norm(), 0.01);
  EXPECT_EQ(box.picture.advice, "");
}

TEST(Review, GoesToTheViewsThatDisagreeOneAfterTheOtherAndWipesThem) {
  Box box;
  box.go_to_capture();
  box.walk();
  box.tick({kReview}, 0.2);
  EXPECT_EQ(box.picture.advice, "");
  box.tick({kReviewLong}, 0.2);
  EXPECT_EQ(box.modes.current(), ModeId::Review) << "there is none to go to";
  EXPECT_EQ(box.picture.world_from_view->translation, around_subject(0.2).translation);

  box.session.quality = {{{2, 17.0}, {5, 16.0}}, {2, 5}, 16.5, {}};
  box.tick({}, 0.2);
  EXPECT_EQ(box.picture.advice, "2 views disagree: hold Review to see them");
  EXPECT_EQ(box.picture.details, "likeness 16.5 dB of 2");
  const auto& light_field = box.recorder.light_field();
  const auto center_of = [&](std::size_t i) { return light_field.perspectives()[i].center(); };
  for (const std::size_t expected : {2U, 5U, 2U}) {
    box.tick({kReviewLong}, 0.2);
    EXPECT_EQ(box.picture.world_from_view->translation, center_of(expected));
    box.tick({}, 0.3);
    EXPECT_EQ(box.picture.world_from_view->translation, center_of(expected)) << "it stays there";
  }
  EXPECT_EQ(box.picture.advice, "view 2 does not fit: Wipe it, or hold Review");
  const std::size_t recorded = box.views();
  box.tick({kWipe}, 0.2);
  EXPECT_EQ(box.views(), recorded - 1);
  EXPECT_EQ(light_field.perspectives()[2].id, 3);
  box.tick({kWipe}, 0.2);
  EXPECT_EQ(box.views(), recorded - 1) << "its neighbours stay";
  box.session.quality.disagreeing = {5};
  box.tick({}, 0.2);
  EXPECT_EQ(box.picture.advice, "1 view disagrees: hold Review to see it");
  box.tick({kWipeLong}, 0.2);
  EXPECT_EQ(light_field.perspectives()[2].id, 2) << "undone";
  box.tick({kMainLong}, 0.2);
  EXPECT_EQ(box.picture.world_from_view->translation, around_subject(0.2).translation)
      << "the box steers again";
}

TEST(Review, OfNothingSaysSo) {
  Box box;
  box.go_to_capture();
  while (box.views() > 0) {
    box.tick({kWipe});
  }
  box.tick({kReview, kWipe, kWipe, kMain, kPlusLong, kMainLong});
  EXPECT_EQ(box.modes.current(), ModeId::Review);
  EXPECT_EQ(box.picture.advice, "nothing recorded yet");
}

// Whatever is pressed whenever, tracked or not: the modes stay consistent, and with a subject there
// is always a way back to the capture.
RC_GTEST_PROP(Modes, SurviveAnyButtons, ()) {
  Box box;
  const int ticks = *rc::gen::inRange(1, 60);
  for (int i = 0; i < ticks; ++i) {
    std::vector<Gesture> gestures;
    for (int g = *rc::gen::inRange(0, 3); g > 0; --g) {
      gestures.push_back({static_cast<Button>(*rc::gen::inRange(0, 5)),
                          *rc::gen::arbitrary<bool>() ? Press::Long : Press::Short});
    }
    if (*rc::gen::inRange(0, 4) == 0) {
      box.tick_with(gestures, box.world.see_nothing(tracking::TrackingReason::Relocalising));
    } else {
      box.tick(gestures, *rc::gen::inRange(-60, 60) * kDegree);
    }
    const bool has_subject = box.recorder.light_field().subject().has_value();
    const ModeId mode = box.modes.current();
    RC_ASSERT(has_subject || mode == ModeId::Acquire || mode == ModeId::Subject);
    RC_ASSERT(!box.recorder.error());
  }
}

/// A box that was switched on with a capture on disk; its map fits, or there is a problem with it.
struct WaitingBox : Box {
  explicit WaitingBox(const std::string& problem = "") {
    {
      Recorder before(testing::small_camera(), config.capture, lightfield::Writing::Inline);
      const Moment moment = world.see_from(around_subject(0.0));
      before.begin({Eigen::Vector3d::UnitZ(), 0.3}, moment, dir / "capture-0001");
      before.record(moment);
      before.finish(world.map());
    }
    const MapNow map = world.map();
    recorder.resume(lightfield::load_capture(dir / "capture-0001"),
                    problem.empty() ? &map : nullptr);
    session.waiting = WaitingCapture{"capture-0001", problem};
    switched_on.emplace(session, testing::small_camera());
  }
  Decision tick(const std::vector<Gesture>& gestures, const Moment& moment) {
    const Decision decision = switched_on->decide(gestures, moment);
    picture = switched_on->draw(moment);
    return decision;
  }
  Decision tick_lost(const std::vector<Gesture>& gestures = {}) {
    return tick(gestures, world.see_nothing(tracking::TrackingReason::Relocalising));
  }
  ModeId mode() const { return switched_on->current(); }

  std::optional<Modes> switched_on;
};

TEST(Resume, WaitsForAKnownPlaceAndGoesOnByItself) {
  WaitingBox box;
  box.tick_lost({kMain, kPlus, kWipe});
  EXPECT_EQ(box.mode(), ModeId::Resume);
  EXPECT_THAT(box.picture.title, HasSubstr("capture-0001  1 views"));
  EXPECT_THAT(box.picture.advice, HasSubstr("point at its subject"));
  const Decision decision = box.tick({}, box.world.see_from(around_subject(0.5)));
  EXPECT_EQ(box.mode(), ModeId::Capture);
  EXPECT_TRUE(decision.record);
  EXPECT_TRUE(decision.hold_exposure);
  EXPECT_FALSE(decision.start_over);
}

TEST(Resume, ANewOneBeginsOnlyWhenAskedFor) {
  WaitingBox box;
  EXPECT_FALSE(box.tick_lost({kMain}).start_over);
  EXPECT_TRUE(box.tick_lost({kMainLong}).start_over);
  EXPECT_EQ(box.mode(), ModeId::Acquire);
  EXPECT_FALSE(box.tick_lost().start_over) << "once";
}

TEST(Resume, ReviewShowsItAndComesBackToWaiting) {
  WaitingBox box;
  box.tick_lost({kReview});
  EXPECT_EQ(box.mode(), ModeId::Review);
  EXPECT_TRUE(box.picture.light_field) << "in an orbit: the box does not know where it is";
  box.tick_lost({kReview});
  EXPECT_EQ(box.mode(), ModeId::Resume);
  box.tick_lost({kReview});
  box.tick({kReview}, box.world.see_from(around_subject(0.5)));
  EXPECT_EQ(box.mode(), ModeId::Capture);
}

// Without its map there is no telling where the capture is: the tracker's world is another one.
TEST(Resume, WithAProblemItIsSaidAndShownAndNothingIsRecorded) {
  WaitingBox box("map/map.json: is damaged");
  const Moment good = box.world.see_from(around_subject(0.5));
  EXPECT_FALSE(box.tick({}, good).record);
  EXPECT_EQ(box.mode(), ModeId::Resume);
  ASSERT_EQ(box.picture.alerts.size(), 1U);
  EXPECT_THAT(box.picture.alerts[0], HasSubstr("map/map.json: is damaged"));
  box.tick({kReview}, good);
  ASSERT_TRUE(box.picture.world_from_view);
  EXPECT_FALSE(box.picture.world_from_view->translation.isApprox(
      good.tracked.world_from_camera->translation, 1e-3))
      << "the view is not the box's, which is in another world";
  EXPECT_FALSE(box.tick({kReview}, good).record);
  EXPECT_EQ(box.mode(), ModeId::Resume);
}

}  // namespace
}  // namespace lumibox::app
