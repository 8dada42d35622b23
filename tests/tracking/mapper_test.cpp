#include "tracking/mapper.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numbers>

#include "geometry/rotation.h"
#include "tracking/textured_world.h"

namespace lumibox::tracking {
namespace {

/// Two views of the wedge and points on it.
InitialMap two_views() {
  const geometry::Camera camera = testing::small_camera();
  const geometry::Pose world_from_second(Eigen::Quaterniond::Identity(), {0.2, 0.0, 0.0});
  InitialMap map;
  map.first = std::make_shared<Pyramid>(testing::render_wedge(camera, {}), 3);
  map.second = std::make_shared<Pyramid>(testing::render_wedge(camera, world_from_second), 3);
  map.second_from_first = world_from_second.inverse();
  for (int i = 0; i < 64; ++i) {
    const double x = 0.2 * (i % 8 - 3.5);
    const Eigen::Vector3d point(x, 0.15 * (i / 8 - 3.5), 2.0 + 0.8 * std::abs(x));
    map.points.push_back(
        {point, *camera.project(point), *camera.project(map.second_from_first * point), 0});
  }
  return map;
}

/// A keyframe that looks away from all points and has no picture: using it throws.
KeyframeRequest broken_keyframe() {
  const geometry::Pose turned(geometry::exp_so3({0.0, std::numbers::pi, 0.0}), {0.0, 0.0, 0.0});
  const hal::Image no_picture(320, 240, /*channels=*/0);
  return {1, turned, geometry::Vector6d::Zero(), std::make_shared<Pyramid>(no_picture, 1), {}, {}};
}

TEST(Mapper, AnExceptionEndsMappingAndLeavesTheMapThatWasThere) {
  config::Tracking options;
  options.pyramid_levels = 3;
  for (const Mapping mapping : {Mapping::Lockstep, Mapping::Threaded}) {
    Mapper mapper(testing::small_camera(), options, mapping);
    mapper.start(two_views());
    const auto before = mapper.view();
    ASSERT_EQ(before->keyframes.size(), 2U);
    EXPECT_FALSE(mapper.error());
    mapper.request(broken_keyframe());
    mapper.finish();
    ASSERT_TRUE(mapper.error());
    EXPECT_FALSE(mapper.error()->empty());
    EXPECT_EQ(mapper.view(), before);
    mapper.request({1, {}, geometry::Vector6d::Zero(), before->keyframes[1].pyramid, {}, {}});
    mapper.finish();
    EXPECT_EQ(mapper.view(), before) << "what an exception left half changed is not built upon";
  }
}

/// The second view again, moved a little.
KeyframeRequest third_keyframe(const MapView& map) {
  const geometry::Pose moved(Eigen::Quaterniond::Identity(), {0.05, 0.0, 0.0});
  const geometry::Pose world_from_camera = map.keyframes[1].world_from_camera * moved;
  const geometry::Camera camera = testing::small_camera();
  KeyframeRequest request{1, moved, geometry::Vector6d::Zero(), map.keyframes[1].pyramid, {}, {}};
  for (const MapView::Point& p : map.points) {
    const auto pixel = camera.project(world_from_camera.inverse() * p.position);
    if (pixel) request.sightings.emplace_back(p.id, Sighting{-1, *pixel, 0});
  }
  return request;
}

TEST(Mapper, RestAdjustsAMapThatHasChangedOnce) {
  config::Tracking options;
  options.pyramid_levels = 3;
  Mapper mapper(testing::small_camera(), options, Mapping::Lockstep);
  mapper.rest();
  EXPECT_FALSE(mapper.error()) << "there is no map yet";
  mapper.start(two_views());
  const std::uint64_t started = mapper.view()->revision;
  mapper.rest();
  EXPECT_EQ(mapper.view()->revision, started) << "the first map is adjusted already";
  mapper.request(third_keyframe(*mapper.view()));
  const std::uint64_t added = mapper.view()->revision;
  mapper.rest();
  EXPECT_EQ(mapper.view()->revision, added + 1);
  mapper.rest();
  EXPECT_EQ(mapper.view()->revision, added + 1);
}

TEST(Mapper, RequestsWhileItAdjustsAtRestAreAllAnswered) {
  config::Tracking options;
  options.pyramid_levels = 3;
  Mapper mapper(testing::small_camera(), options, Mapping::Threaded);
  mapper.start(two_views());
  const KeyframeRequest request = third_keyframe(*mapper.view());
  for (int i = 0; i < 5; ++i) {
    mapper.request(request);
    mapper.rest();
  }
  mapper.finish();
  EXPECT_FALSE(mapper.error());
  EXPECT_EQ(mapper.view()->keyframes.size(), 7U);
  mapper.request(request);
  mapper.rest();
  mapper.finish();
  EXPECT_EQ(mapper.view()->keyframes.size(), 8U);
}

// A picture that asks the mapper something when it ends would wait for itself if that were done
// with the lock held, for which the loop waits too.
TEST(Mapper, WhatIsWorkedOffEndsOutsideTheLock) {
  config::Tracking options;
  options.pyramid_levels = 3;
  Mapper mapper(testing::small_camera(), options, Mapping::Threaded);
  mapper.start(two_views());
  mapper.request(broken_keyframe());  // from now on pictures are kept by nobody
  mapper.finish();
  std::atomic<int> ended = 0;
  for (int i = 0; i < 3; ++i) {
    KeyframeRequest request = broken_keyframe();
    request.pyramid = std::shared_ptr<const Pyramid>(request.pyramid.get(),
                                                     [&, kept = request.pyramid](const Pyramid*) {
                                                       EXPECT_TRUE(mapper.busy());
                                                       ++ended;
                                                     });
    mapper.request(std::move(request));
  }
  mapper.finish();
  EXPECT_EQ(ended, 3);
}

}  // namespace
}  // namespace lumibox::tracking
