#include "app/placement.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace lumibox::app {
namespace {

const Ray kAhead{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};

/// A grid of points on a plane at a depth, half as wide as it is far.
void add_wall(std::vector<Eigen::Vector3d>& points, double depth, int per_side, double width) {
  for (int y = 0; y < per_side; ++y) {
    for (int x = 0; x < per_side; ++x) {
      points.emplace_back(width * (x / (per_side - 1.0) - 0.5),
                          width * (y / (per_side - 1.0) - 0.5), depth);
    }
  }
}

TEST(Placement, DepthIsThatOfTheThingInTheReticleNotOfTheWallBehindIt) {
  std::vector<Eigen::Vector3d> points;
  add_wall(points, 5.0, 30, 6.0);
  add_wall(points, 1.0, 6, 0.2);
  EXPECT_NEAR(depth_on_ray(kAhead, points).value(), 1.0, 1e-12);
}

TEST(Placement, AFewWrongPointsDoNotMatter) {
  std::vector<Eigen::Vector3d> points;
  add_wall(points, 2.0, 5, 0.4);
  for (int i = 0; i < 5; ++i) {
    points.emplace_back(0.0, 0.001 * i, 0.1);
  }
  EXPECT_NEAR(depth_on_ray(kAhead, points).value(), 2.0, 1e-12);
}

TEST(Placement, PointsBehindTheCameraDoNotCount) {
  std::vector<Eigen::Vector3d> points;
  add_wall(points, -2.0, 5, 0.4);
  EXPECT_FALSE(depth_on_ray(kAhead, points));
  EXPECT_FALSE(depth_on_ray(kAhead, {}));
}

RC_GTEST_PROP(Placement, SlidingBackUndoesSliding, ()) {
  const double depth = *rc::gen::inRange(1, 10000) * 1e-2;
  const int steps = *rc::gen::inRange(-60, 60);
  const double there = slide_depth(depth, steps, 0.05);
  RC_ASSERT(there > 0.0);
  RC_ASSERT((steps > 0) == (there > depth));
  RC_ASSERT(std::abs(slide_depth(there, -steps, 0.05) - depth) < 1e-9 * depth);
}

TEST(Placement, RayOfTheReticleLooksAlongTheOpticalAxis) {
  config::CameraProfile profile;
  profile.k1 = -0.2;
  const geometry::Camera camera(profile);
  const geometry::Pose world_from_camera(geometry::exp_so3({0.0, 0.5, 0.0}), {1.0, 2.0, 3.0});
  const Ray ray = ray_of_pixel(camera, world_from_camera, reticle(camera)).value();
  EXPECT_TRUE(ray.origin.isApprox(Eigen::Vector3d(1.0, 2.0, 3.0)));
  EXPECT_TRUE(ray.direction.isApprox(world_from_camera.rotation * Eigen::Vector3d::UnitZ()));
}

TEST(Placement, SphereSitsOnTheRayAndGrowsWithItsDistance) {
  config::Capture options;
  options.sphere_radius_share = 0.25;
  const auto sphere = sphere_on_ray(kAhead, 4.0, options);
  EXPECT_EQ(sphere.center, Eigen::Vector3d(0.0, 0.0, 4.0));
  EXPECT_EQ(sphere.radius, 1.0);
}

}  // namespace
}  // namespace lumibox::app
