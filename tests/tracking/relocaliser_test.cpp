#include "tracking/relocaliser.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tracking/corners.h"
#include "tracking/map.h"
#include "tracking/relocalisation.h"
#include "tracking/textured_world.h"

namespace lumibox::tracking {
namespace {

constexpr int kKeyframes = 12;

config::Tracking options() {
  config::Tracking o;
  o.pyramid_levels = 3;
  return o;
}

geometry::Pose place(double step) {
  return {Eigen::Quaterniond::Identity(), {0.08 * step, 0.0, 0.0}};
}

std::shared_ptr<const Pyramid> picture_from(const geometry::Pose& world_from_camera) {
  return std::make_shared<Pyramid>(
      testing::render_wedge(testing::small_camera(), world_from_camera), 3);
}

/// A row of keyframes before the wedge, each with the points at its own corners.
MapView row_of_keyframes() {
  const geometry::Camera camera = testing::small_camera();
  Map map;
  for (int i = 0; i < kKeyframes; ++i) {
    const KeyframeId id = map.add_keyframe(place(i).inverse(), picture_from(place(i)));
    for (const Corner& corner : detect_corners(*map.keyframe(id).pyramid, 20, 300)) {
      const Eigen::Vector2d pixel = from_level(corner.pixel, corner.level);
      const Eigen::Vector3d ray = camera.unproject(pixel)->homogeneous();
      const double origin = place(i).translation.x();
      for (const double slope : {0.8, -0.8}) {  // z = 2 + slope x, on its own side of x = 0
        const double depth = (2.0 + slope * origin) / (1.0 - slope * ray.x());
        const Eigen::Vector3d point = place(i) * Eigen::Vector3d(depth * ray);
        if (depth > 0.0 && point.x() * slope >= 0.0) {
          map.add_sighting(map.add_point(point), {id, pixel, corner.level});
          break;
        }
      }
    }
  }
  return map.view(1);
}

// A picture without corners matches nothing, whatever is described.
TEST(Relocaliser, FindsThePlaceAndDescribesFewKeyframesInAFrame) {
  const MapView map = row_of_keyframes();
  Relocaliser relocaliser(testing::small_camera(), options(), 1);
  const auto frame = picture_from(place(4.5));
  std::vector<geometry::Pose> found;
  int frames = 0;
  for (int before = 0; found.empty() && frames < 6; ++frames) {
    found = relocaliser.find(map, *frame, SmallImage(*frame));
    EXPECT_LE(relocaliser.described() - before, 2) << "a lost frame must not take too long";
    before = relocaliser.described();
  }
  EXPECT_GT(frames, 1) << "all that look alike are described before any is believed";
  ASSERT_FALSE(found.empty());
  EXPECT_LE(relocaliser.described(), kKeyframes / 2) << "only those that look alike";
  for (const geometry::Pose& pose : found) {
    EXPECT_LT((pose.inverse().translation - place(4.5).translation).norm(), 0.02);
  }
  const Pyramid blank(hal::Image(320, 240, 1), 3);
  EXPECT_TRUE(relocaliser.find(map, blank, SmallImage(blank)).empty());
}

TEST(Relocaliser, WhatIsPreparedAnswersInTheFirstLostFrame) {
  const MapView map = row_of_keyframes();
  Relocaliser relocaliser(testing::small_camera(), options(), 1);
  const auto frame = picture_from(place(4.5));
  for (int i = 0; i < 3; ++i) relocaliser.prepare(map, SmallImage(*frame));
  EXPECT_FALSE(relocaliser.find(map, *frame, SmallImage(*frame)).empty());
}

/// A camera on a circle of radius 1 around the origin, looking at it.
geometry::Pose around(double angle) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()));
  return geometry::Pose(turn, turn * Eigen::Vector3d(0.0, 0.0, -1.0)).inverse();
}

LastSeen seen(double seconds_ago) {
  return {around(0.0), 1.0, seconds_ago};
}

TEST(ChoosePlace, TheBackOfACanIsNotItsFrontHalfASecondLater) {
  const std::vector<PossiblePlace> back = {{around(std::numbers::pi), 300}};
  EXPECT_FALSE(choose_place(back, seen(0.5)));
  EXPECT_EQ(choose_place(back, seen(5.0)), 0U);
}

TEST(ChoosePlace, OfTwoThatLookAlikeTheReachableOneIsBelieved) {
  const std::vector<PossiblePlace> both = {{around(std::numbers::pi), 300}, {around(0.2), 280}};
  EXPECT_EQ(choose_place(both, seen(0.5)), 1U);
}

TEST(ChoosePlace, StaysLostWhereNothingTellsTwoPlacesApart) {
  const std::vector<PossiblePlace> both = {{around(std::numbers::pi), 300}, {around(0.2), 280}};
  EXPECT_FALSE(choose_place(both, seen(5.0)));
  const std::vector<PossiblePlace> clear = {{around(std::numbers::pi), 300}, {around(0.2), 100}};
  EXPECT_EQ(choose_place(clear, seen(5.0)), 0U);
}

TEST(ChoosePlace, SeveralKeyframesThatAgreeAreOnePlace) {
  const std::vector<PossiblePlace> same = {{around(0.1), 200}, {around(0.11), 210}};
  EXPECT_EQ(choose_place(same, seen(5.0)), 1U);
  EXPECT_FALSE(choose_place({}, seen(5.0)));
}

}  // namespace
}  // namespace lumibox::tracking
