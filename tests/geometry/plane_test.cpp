#include "geometry/plane.h"

#include <gtest/gtest.h>

#include "geometry/pose.h"

namespace lumibox::geometry {
namespace {

using Eigen::Vector3d;

TEST(Plane, MeetsARayInFrontOnly) {
  const Plane plane = Plane::through({0.0, 0.0, 2.0}, {0.0, 0.0, -5.0});
  const auto hit = intersect(plane, {1.0, 0.0, 0.0}, {0.0, 0.5, 1.0});
  ASSERT_TRUE(hit);
  EXPECT_LT((*hit - Vector3d(1.0, 1.0, 2.0)).norm(), 1e-15);
  EXPECT_FALSE(intersect(plane, {1.0, 0.0, 0.0}, {0.0, 0.5, -1.0}));
  EXPECT_FALSE(intersect(plane, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}));
}

TEST(Plane, MovesWithItsPoints) {
  const Plane plane = Plane::through({0.3, 0.2, 2.0}, {0.1, 0.4, -1.0});
  const Pose pose(exp_so3({0.3, 0.2, 0.1}), {1.0, 2.0, 3.0});
  EXPECT_NEAR(transform(pose, plane).signed_distance(pose * Vector3d(0.3, 0.2, 2.0)), 0.0, 1e-15);
}

TEST(Plane, HomographyMapsItsPoints) {
  const Plane plane = Plane::through({0.3, 0.2, 2.0}, {0.1, 0.4, -1.0});
  const Pose b_from_a(exp_so3({0.1, 0.0, 0.2}), {0.3, 0.0, 0.1});
  const auto h = plane_homography(b_from_a, plane);
  ASSERT_TRUE(h);
  const Vector3d on_plane = *intersect(plane, Vector3d::Zero(), {0.1, -0.3, 1.0});
  const Vector3d mapped = *h * (on_plane / on_plane.z());
  const Vector3d expected = b_from_a * on_plane;
  EXPECT_LT((mapped.hnormalized() - expected.hnormalized()).norm(), 1e-15);
  EXPECT_FALSE(plane_homography(b_from_a, Plane{Vector3d::UnitX(), 0.0}));
}

}  // namespace
}  // namespace lumibox::geometry
