#include "geometry/absolute_pose.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "geometry/p3p.h"
#include "geometry/two_view_scene.h"

namespace lumibox::geometry {
namespace {

using Eigen::Vector3d;

struct Views {
  std::vector<Vector3d> points;
  std::vector<Vector3d> bearings;
};

Views look_at_random_points(TwoViewScene* scene, const Pose& pose, int count, double sigma_rad) {
  Views views;
  for (const Vector3d& in_camera : scene->volume(count, 2.0, 6.0)) {
    views.points.push_back(pose.inverse() * in_camera);
    views.bearings.push_back(scene->look(in_camera, sigma_rad));
  }
  return views;
}

// 1e-6 although the worst of ten thousand seen is 2e-11: rare triples are near a double root.
RC_GTEST_PROP(P3p, ThreePointsYieldTheTruePose, (std::uint32_t seed)) {
  TwoViewScene scene(seed);
  const Pose pose(exp_so3(3.0 * scene.direction()), 5.0 * scene.direction());
  const Views v = look_at_random_points(&scene, pose, 3, 0.0);
  double nearest = 1e9;
  for (const Pose& found : solve_p3p({v.points[0], v.points[1], v.points[2]},
                                     {v.bearings[0], v.bearings[1], v.bearings[2]})) {
    nearest = std::min(nearest, (found.matrix4() - pose.matrix4()).norm());
  }
  RC_ASSERT(nearest < 1e-6);
}

TEST(AbsolutePose, IsFoundAmongHalfOutliers) {
  TwoViewScene scene(2);
  const Pose pose(exp_so3({0.5, -1.0, 0.2}), {1.0, 2.0, 3.0});
  Views v = look_at_random_points(&scene, pose, 200, 5e-4);
  for (std::size_t i = 0; i < 100; ++i) v.bearings[i] = scene.look(Vector3d(0, 0, 1), 0.3);
  const auto found = solve_absolute_pose(v.points, v.bearings, 2e-3, 1);
  ASSERT_TRUE(found);
  // 5e-4 rad over 100 points at a distance of 4: 2e-4 per axis and more in depth; ten times that.
  EXPECT_LT((found->camera_from_world.translation - pose.translation).norm(), 4e-3);
  EXPECT_GT(found->inlier_count, 95);
}

// Moving, turning and scaling the world must change the pose in just that way; what differs is
// rounding, amplified by the scale.
RC_GTEST_PROP(AbsolutePose, FollowsTheWorld, (std::uint32_t seed)) {
  TwoViewScene scene(seed);
  const Pose pose(exp_so3({0.1, 0.2, 0.3}), {0.5, -0.5, 1.0});
  const Views v = look_at_random_points(&scene, pose, 40, 0.0);
  const Similarity moved{scene.uniform(0.1, 10.0),
                         Pose(exp_so3(3.0 * scene.direction()), 20.0 * scene.direction())};
  std::vector<Vector3d> points;
  for (const Vector3d& p : v.points) points.push_back(moved * p);
  const auto found = solve_absolute_pose(points, v.bearings, 1e-3, 1);
  RC_ASSERT(found.has_value());
  const Pose expected = moved * pose.inverse();
  RC_ASSERT((found->camera_from_world.inverse().matrix4() - expected.matrix4()).norm() < 1e-8);
}

}  // namespace
}  // namespace lumibox::geometry
