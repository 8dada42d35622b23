#include "bench/simulated_capture.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "hal/sim_scenes.h"
#include "lightfield/light_field.h"
#include "support/small_scene.h"

namespace lumibox::bench {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

std::shared_ptr<const hal::Scene> small_scene() {
  return hal::testing::scene_of(testing::kSmallScene);
}

double angle(const Walk& walk, const geometry::Pose& a, const geometry::Pose& b) {
  return lightfield::angle_at_subject(a.translation, walk.subject.center, b.translation);
}

/// A walk of single steps, azimuths in degrees around a subject at the origin.
Walk walk_at(const std::vector<double>& azimuths_deg) {
  Walk walk;
  walk.camera = std::make_shared<const geometry::Camera>();
  walk.poses = {{0.0, geometry::Pose(Eigen::Quaterniond::Identity(), {0.0, -1.0, 0.0})}};
  const Walk one = walk;
  walk.poses.clear();
  for (const double azimuth : azimuths_deg) {
    walk.poses.push_back(
        {static_cast<double>(walk.poses.size()), pose_around(one, azimuth * kRadians, 0.0)});
  }
  return walk;
}

TEST(SimulatedCapture, WalkHasTheTruePoseOfEachFrame) {
  const auto scene = small_scene();
  const Walk walk = walk_of(*scene);
  ASSERT_EQ(walk.poses.size(), 60U);
  const double time_s = walk.poses[17].timestamp_s;
  EXPECT_NEAR(time_s, 17.0 / 30.0, 1e-6);
  EXPECT_EQ(walk.poses[17].world_from_camera.translation,
            scene->world_from_camera(time_s).translation);
  EXPECT_EQ(walk.subject.radius, 0.15);
}

RC_GTEST_PROP(SimulatedCapture, RecordsWhatTheGateWould, ()) {
  static const Walk walk = walk_of(*small_scene());
  const double threshold = kRadians * *rc::gen::inRange(1, 20);
  const auto recorded = recorded_along(walk, threshold);
  RC_ASSERT(recorded.front() == 0U);
  std::size_t next = 0;
  for (std::size_t i = 0; i < walk.poses.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < next; ++j) {
      nearest = std::min(nearest, angle(walk, walk.poses[i].world_from_camera,
                                        walk.poses[recorded[j]].world_from_camera));
    }
    const bool is_recorded = next < recorded.size() && recorded[next] == i;
    RC_ASSERT(is_recorded == (nearest > threshold));
    if (is_recorded) ++next;
  }
}

RC_GTEST_PROP(SimulatedCapture, UnseenViewsAreNeverNearARecordedOne, ()) {
  static const Walk walk = walk_of(*small_scene());
  const double least = 0.1 * kRadians * *rc::gen::inRange(1, 10);
  std::vector<std::vector<std::size_t>> recorded;
  for (int i = 0; i < 2; ++i) {
    recorded.push_back(recorded_along(walk, kRadians * *rc::gen::inRange(2, 12)));
  }
  const std::size_t count = *rc::gen::inRange<std::size_t>(1, 15);
  const auto unseen = unseen_along(walk, recorded, count, least);
  RC_ASSERT(!unseen.empty());
  RC_ASSERT(unseen.size() <= count);
  RC_ASSERT(std::ranges::is_sorted(unseen));
  for (const std::size_t view : unseen) {
    for (const auto& set : recorded) {
      RC_ASSERT(set.front() < view && view < set.back());
      for (const std::size_t other : set) {
        RC_ASSERT(angle(walk, walk.poses[view].world_from_camera,
                        walk.poses[other].world_from_camera) > least);
      }
    }
  }
}

TEST(SimulatedCapture, UnseenViewsAreTheFarthestOfTheirStretch) {
  const Walk walk = walk_at({0, 2, 5, 7, 10, 11, 13, 15, 19, 20, 25});
  EXPECT_EQ(unseen_along(walk, {{0, 4, 9}}, 2, 1e-3), (std::vector<std::size_t>{2, 7}))
      << "at 5 and at 15 degrees";
}

TEST(SimulatedCapture, WithoutRoomBetweenTheRecordedNothingIsUnseen) {
  const Walk walk = walk_at({0, 1, 2, 3, 4});
  EXPECT_TRUE(unseen_along(walk, {{0, 2, 4}}, 3, 1.5 * kRadians).empty());
  EXPECT_TRUE(unseen_along(walk, {{0}}, 3, 0.1 * kRadians).empty()) << "nothing lies between one";
  EXPECT_TRUE(unseen_along(walk, {{}}, 3, 0.1 * kRadians).empty());
}

TEST(SimulatedCapture, ViewsThatLookAwayDoNotCount) {
  Walk walk = walk_at({0, 5, 10});
  EXPECT_EQ(unseen_along(walk, {{0, 2}}, 1, kRadians).size(), 1U);
  const Eigen::AngleAxisd about(std::numbers::pi, Eigen::Vector3d::UnitY());
  walk.poses[1].world_from_camera.rotation = walk.poses[1].world_from_camera.rotation * about;
  EXPECT_TRUE(unseen_along(walk, {{0, 2}}, 1, kRadians).empty());
}

TEST(SimulatedCapture, AroundTheSubjectIsEvenlyCovered) {
  const Walk walk = walk_at({0});
  const auto poses = around_subject(walk, 100);
  ASSERT_EQ(poses.size(), 100U);
  // That many equal discs on the band between 5 and 55 degrees would have this radius.
  const double radius = std::acos(1.0 - (std::sin(55 * kRadians) - std::sin(5 * kRadians)) / 100);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const geometry::Pose& pose = poses[i].world_from_camera;
    EXPECT_NEAR(pose.translation.norm(), 1.0, 1e-9);
    EXPECT_NEAR((pose.inverse() * walk.subject.center).z(), 1.0, 1e-9) << "looks at it";
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(angle(walk, pose, poses[j].world_from_camera), radius) << i << " " << j;
    }
  }
}

TEST(SimulatedCapture, RecordsThePictureThatTheSimulatorSees) {
  const auto scene = small_scene();
  const Walk walk = walk_of(*scene);
  const auto perspective = record(*scene, walk, 4, walk.poses[9]);
  EXPECT_EQ(perspective.id, 4);
  EXPECT_EQ(perspective.timestamp_ns, 300'000'000);
  EXPECT_EQ(perspective.camera->width(), 48);
  EXPECT_EQ(*perspective.photo->rgb(),
            scene->render_ideal(*walk.camera, walk.poses[9].world_from_camera,
                                walk.poses[9].timestamp_s));
}

}  // namespace
}  // namespace lumibox::bench
