#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "geometry/robust.h"
#include "render/ball_scene.h"
#include "render/depth_grid.h"
#include "render/depth_maps.h"
#include "render/proxy_geometry.h"
#include "support/photo.h"

namespace lumibox::render {
namespace {

using Eigen::Vector3d;
using lightfield::Perspective;

/// Inverse depth of the ball or the shell around it, along a ray of length 1 in z in the camera.
double true_inverse_depth(const geometry::Pose& world_from_camera, const Vector3d& ray) {
  const Vector3d origin = world_from_camera.translation;
  const Vector3d direction = world_from_camera.rotation * ray;
  const double a = direction.squaredNorm();
  const double b = origin.dot(direction);
  const auto root = [&](double radius) {
    return b * b - a * (origin.squaredNorm() - radius * radius);
  };
  const double ball = root(1.0);
  return ball > 0.0 ? a / (-b - std::sqrt(ball)) : a / (-b + std::sqrt(root(10.0)));
}

/// A map of one inverse depth, seen by a small pinhole camera.
DepthGrid::Source flat(double inverse_depth, const geometry::Pose& world_from_map) {
  const std::vector<float> flat(40 * 30, static_cast<float>(inverse_depth));
  const std::vector<float> sure(40 * 30, 1.0F);
  return {std::make_shared<DepthMap>(test::make_camera(40, 30), flat, sure), world_from_map, 1.0};
}

// Half a step between the depths searched is 0.03 of the distance; ten times that is a pixel that
// was mistaken, mostly at the ball's edge, where maps cannot be sharp.
TEST(DepthMap, IsTheDepthOfWhatThePicturesShow) {
  for (const bool distorted : {false, true}) {
    const auto perspectives = around_a_ball(test::make_camera(192, 144, distorted));
    std::vector<const Perspective*> others;
    for (const std::size_t i : depth_neighbours(perspectives, 0, kSubject)) {
      others.push_back(&perspectives[i]);
    }
    ASSERT_EQ(others.size(), 4U);
    const DepthMap map = estimate_depth(perspectives[0], others, kSubject).value();
    std::vector<double> errors;
    std::size_t i = 0;
    for (int y = 0; y < map.camera.height(); ++y) {
      for (int x = 0; x < map.camera.width(); ++x, ++i) {
        const double wanted =
            true_inverse_depth(perspectives[0].world_from_camera, ray_at(map.camera, x, y));
        errors.push_back(std::abs(static_cast<double>(map.inverse_depth(i)) - wanted) * 4.0);
      }
    }
    EXPECT_LT(geometry::quantile(errors, 0.5), 0.03) << distorted;
    EXPECT_LT(geometry::quantile(errors, 0.85), 0.3) << distorted;
  }
}

// All that a recorded perspective of 640x480 may cost is 500 kB.
TEST(DepthMap, OfAPictureOf640x480Takes60KilobytesAtMost) {
  Perspective perspective = around_a_ball(test::make_camera(8, 6), 1)[0];
  perspective.camera = std::make_shared<const geometry::Camera>(test::make_camera(640, 480));
  perspective.photo = testing::photo_of(hal::Image(640, 480, 3));
  const DepthMap map = estimate_depth(perspective, {}, kSubject).value();
  EXPECT_EQ(map.size(), 160U * 120U);
  EXPECT_LE(map.shares.size() * sizeof map.shares[0] + map.agreement.size(), 60'000U);
}

RC_GTEST_PROP(DepthMap, KeepsInverseDepthsToA65535thOfTheLargest, ()) {
  std::vector<float> inverse_depths;
  std::vector<float> confidences;
  for (int i = 0; i < 12; ++i) {
    inverse_depths.push_back(static_cast<float>(*rc::gen::inRange(0, 1 << 20)) * 1e-4F);
    confidences.push_back(static_cast<float>(*rc::gen::inRange(2, 101)) * 0.01F);
  }
  const float largest = *std::ranges::max_element(inverse_depths);
  const DepthMap map(test::make_camera(4, 3), inverse_depths, confidences);
  for (std::size_t i = 0; i < 12; ++i) {
    RC_ASSERT(std::abs(map.inverse_depth(i) - inverse_depths[i]) <= 0.51F / 65535.0F * largest);
    RC_ASSERT(std::abs(map.confidence(i) - confidences[i]) <= 0.51F / 255.0F);
    RC_ASSERT(map.confidence(i) > 0.0F);
  }
}

TEST(DepthMap, WithoutNeighboursLiesAtTheFocus) {
  const auto perspectives = around_a_ball(test::make_camera(48, 36), 1);
  EXPECT_TRUE(depth_neighbours(perspectives, 0, kSubject).empty());
  const DepthMap map = estimate_depth(perspectives[0], {}, kSubject).value();
  const double wanted = 1.0 / perspectives[0].center().norm();
  for (std::size_t i = 0; i < map.size(); ++i) EXPECT_NEAR(map.inverse_depth(i), wanted, 1e-6);
}

TEST(DepthMap, OfALostPictureThereIsNone) {
  auto perspectives = around_a_ball(test::make_camera(48, 36), 4);
  const std::vector<const Perspective*> one = {&perspectives[1]};
  const DepthMap from_one = estimate_depth(perspectives[0], one, kSubject).value();
  perspectives[2].photo->stored_in("/nowhere/2.png");
  EXPECT_EQ(estimate_depth(perspectives[0], {&perspectives[1], &perspectives[2]}, kSubject)->shares,
            from_one.shares)
      << "one that is lost counts for nothing";
  EXPECT_FALSE(estimate_depth(perspectives[2], one, kSubject));
  DepthMaps maps(Estimating::AtOnce);
  EXPECT_EQ(maps.map_of(perspectives, 2, kSubject), nullptr);
  EXPECT_THAT(depth_neighbours(perspectives, 0, kSubject), ::testing::Not(::testing::Contains(2U)));
}

TEST(DepthMap, NeighboursAreTheNearestThatShowParallax) {
  std::vector<Perspective> perspectives;
  for (const double angle : {0.0, 0.01, 0.5, 0.1, 0.2, 0.3, 0.4}) {
    Perspective p = around_a_ball(test::make_camera(8, 6), 1)[0];
    p.world_from_camera = test::look_at({std::sin(angle), 0.0, -std::cos(angle)}, kSubject);
    perspectives.push_back(p);
  }
  EXPECT_EQ(depth_neighbours(perspectives, 0, kSubject), (std::vector<std::size_t>{3, 4, 5, 6}));
}

std::shared_ptr<const DepthMap> wait_for(DepthMaps& maps,
                                         const std::vector<Perspective>& perspectives,
                                         const std::shared_ptr<const DepthMap>& other_than) {
  while (true) {
    auto map = maps.map_of(perspectives, 0, kSubject);
    if (map != other_than) return map;
    std::this_thread::yield();
  }
}

TEST(DepthMaps, MeanwhileGivesWhatAtOnceGives) {
  auto perspectives = around_a_ball(test::make_camera(48, 36), 4);
  DepthMaps at_once(Estimating::AtOnce);
  const auto wanted = at_once.map_of(perspectives, 0, kSubject);
  EXPECT_EQ(at_once.map_of(perspectives, 0, kSubject), wanted) << "it is kept";
  DepthMaps meanwhile(Estimating::Meanwhile);
  const auto found = wait_for(meanwhile, perspectives, nullptr);
  EXPECT_EQ(found->shares, wanted->shares);
  EXPECT_EQ(found->agreement, wanted->agreement);

  perspectives.push_back(around_a_ball(test::make_camera(48, 36), 5).back());
  const auto better = wait_for(meanwhile, perspectives, found);  // until then the older one
  EXPECT_EQ(better->shares, at_once.map_of(perspectives, 0, kSubject)->shares);
}

TEST(DepthMaps, AMapStaysWhenItsPerspectiveMoves) {
  auto perspectives = around_a_ball(test::make_camera(48, 36), 4);
  DepthMaps maps(Estimating::AtOnce);
  const auto before = maps.map_of(perspectives, 0, kSubject);
  for (Perspective& p : perspectives) p.world_from_camera.translation.x() += 1e-3;
  EXPECT_EQ(maps.map_of(perspectives, 0, kSubject), before);
}

TEST(DepthMaps, EndsWhileItWorks) {
  const auto perspectives = around_a_ball(test::make_camera(192, 144), 5);
  DepthMaps maps(Estimating::Meanwhile);
  for (std::size_t i = 0; i < 5; ++i) maps.map_of(perspectives, i, kSubject);
}

TEST(DepthGrid, WithoutMapsIsTheFallback) {
  const DepthGrid grid(view_from({0.0, 0.0, -4.0}), {}, 0.25);
  for (const float rho : grid.inverse_depths()) EXPECT_EQ(rho, 0.25F);
}

TEST(DepthGrid, AMapOfTheSameViewStaysWhatItIs) {
  const View view = view_from({0.0, 0.0, -4.0});
  const DepthGrid grid(view, {flat(0.2, view.world_from_camera)}, 0.25);
  for (const float rho : grid.inverse_depths()) EXPECT_NEAR(rho, 0.2, 1e-6);
}

// The map sees half of the view: the rest continues it.
TEST(DepthGrid, HasNoHoles) {
  const View view = view_from({0.0, 0.0, -4.0});
  geometry::Pose aside = view.world_from_camera;
  aside.translation.x() += 2.0;
  const DepthGrid grid(view, {flat(0.25, aside)}, 0.1);
  for (const float rho : grid.inverse_depths()) EXPECT_NEAR(rho, 0.25, 1e-4);
}

TEST(DepthGrid, WhatIsNearerCountsMore) {
  const View view = view_from({0.0, 0.0, -4.0});
  const geometry::Pose& pose = view.world_from_camera;
  const DepthGrid grid(view, {flat(0.1, pose), flat(0.4, pose)}, 0.25);
  EXPECT_GT(grid.at(48.0, 36.0), 0.39);
}

TEST(DepthGrid, IsBilinearBetweenCorners) {
  const auto perspectives = around_a_ball(test::make_camera(96, 72), 5);
  ProxyGeometry proxy({}, Estimating::AtOnce);
  Settings settings;
  settings.focus = kSubject;
  const View view = view_from({0.1, 0.1, -4.0});
  const auto shape = proxy.fit(settings, Geometry::Mesh, view, perspectives).shape;
  ASSERT_TRUE(shape);
  const DepthGrid* grid = &shape->grid;
  const double c = grid->cell();
  const double middle = grid->at(10.5 * c, 7.5 * c);
  const double corners = grid->at(10 * c, 7 * c) + grid->at(11 * c, 7 * c) +
                         grid->at(10 * c, 8 * c) + grid->at(11 * c, 8 * c);
  EXPECT_NEAR(middle, 0.25 * corners, 1e-6);
}

}  // namespace
}  // namespace lumibox::render
