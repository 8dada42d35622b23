#include "tracking/keyframe_culling.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "geometry/rotation.h"

namespace lumibox::tracking {
namespace {

/// Keyframes along x that all see the same points, 1 away: a new one is asked for after 0.079.
class CullKeyframes : public ::testing::Test {
 protected:
  static constexpr int kPoints = 40;

  CullKeyframes() {
    for (int i = 0; i < kPoints; ++i) {
      map_.add_point({0.02 * i - 0.4, 0.1 * (i % 5) - 0.2, 1.0});
    }
  }

  KeyframeId add(double x, double turned = 0.0, int level = 0) {
    const geometry::Pose world_from_camera(geometry::exp_so3({0.0, 0.0, turned}),
                                           Eigen::Vector3d(x, 0.0, 0.0));
    const KeyframeId id = map_.add_keyframe({world_from_camera.inverse(), {}}, pyramid_);
    for (PointId p = 0; p < kPoints; ++p) {
      if (map_.has_point(p)) map_.add_sighting(p, {id, Eigen::Vector2d(p, id), level});
    }
    map_.update_depths();
    return id;
  }

  /// Three more that are too far away to stand in, and too new to go.
  int cull(int level = 0) {
    KeyframeId newest = 0;
    for (int i = 0; i < 3; ++i) newest = add(1.0 + 0.1 * i, 0.0, level);
    return cull_keyframes(options_, map_, newest);
  }

  config::Tracking options_;
  Map map_;
  std::shared_ptr<const Pyramid> pyramid_ =
      std::make_shared<const Pyramid>(hal::Image(32, 32, 1), 2);
};

TEST_F(CullKeyframes, TheYoungerOfTwoInOnePlaceGoes) {
  for (const double x : {0.0, 0.1, 0.2, 0.3}) add(x);
  const KeyframeId again = add(0.21);
  EXPECT_EQ(cull(), 1);
  EXPECT_TRUE(map_.keyframe(again).culled());
  EXPECT_EQ(map_.keyframe(again).tied_to, 2);
  EXPECT_EQ(map_.world_from_keyframe(again).rigid.translation.x(), 0.21);
  EXPECT_EQ(map_.points().size(), static_cast<std::size_t>(kPoints)) << "no point is lost";
}

TEST_F(CullKeyframes, AWalkLeavesNoneToCull) {
  for (int i = 0; i < 10; ++i) add(0.08 * i);
  EXPECT_EQ(cull(), 0);
}

TEST_F(CullKeyframes, OfAPileOneStays) {
  for (const double x : {0.0, 0.1, 0.2, 0.3}) add(x);
  for (int i = 0; i < 12; ++i) add(0.2 + 0.001 * i);
  EXPECT_EQ(cull(), 12);
  EXPECT_FALSE(map_.keyframe(2).culled());
}

TEST_F(CullKeyframes, AnotherViewFromOnePlaceStays) {
  for (const double x : {0.0, 0.1, 0.2, 0.3}) add(x);
  add(0.2, 0.5);
  EXPECT_EQ(cull(), 0);
}

TEST_F(CullKeyframes, WhatOnlyItSeesFromNearStays) {
  for (const double x : {0.0, 0.1, 0.2, 0.3}) add(x, 0.0, 1);
  add(0.21, 0.0, 0);
  EXPECT_EQ(cull(1), 0);
}

TEST_F(CullKeyframes, OnlyPointsThatOthersKnowMayLoseAView) {
  for (const double x : {0.0, 0.1, 0.2, 0.3}) add(x);
  const KeyframeId again = add(0.21);
  for (int i = 0; i < 10; ++i) {  // a fifth of its points
    const PointId p = map_.add_point({0.3, 0.3, 1.0});
    for (const KeyframeId k : {2, again}) map_.add_sighting(p, {k, Eigen::Vector2d::Zero(), 0});
  }
  EXPECT_EQ(cull(), 0);
}

TEST_F(CullKeyframes, ARowOfNeighboursIsThinnedNotRemoved) {
  for (int i = 0; i < 10; ++i) add(0.03 * i);
  EXPECT_EQ(cull(), 5);
  for (KeyframeId id = 0; id < 10; ++id) EXPECT_EQ(map_.keyframe(id).culled(), id % 2 == 1) << id;
}

TEST_F(CullKeyframes, TheOriginStays) {
  const KeyframeId origin = add(0.0, 0.0, 1);
  add(0.001);  // sees from nearer: it would stand in
  for (const double x : {0.1, 0.2, 0.3}) add(x, 0.0, 1);
  EXPECT_EQ(cull(1), 0);
  EXPECT_FALSE(map_.keyframe(origin).culled());
}

TEST_F(CullKeyframes, TheNewestStay) {
  KeyframeId newest = 0;
  for (const double x : {0.0, 0.1, 0.2, 0.3, 0.101, 0.201, 0.301}) newest = add(x);
  EXPECT_EQ(cull_keyframes(options_, map_, newest), 0);
  newest = add(0.4);
  EXPECT_EQ(cull_keyframes(options_, map_, newest), 1);
}

}  // namespace
}  // namespace lumibox::tracking
