#include "tracking/pose_refinement.h"

#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "tracking/map.h"
#include "tracking/textured_world.h"

namespace lumibox::tracking {
namespace {

/// Points before a camera, and what it measures of them, exactly but for the float.
class PoseRefinement : public ::testing::Test {
 protected:
  PoseRefinement() {
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d point(0.2 * (i % 10) - 0.9, 0.15 * (i / 10) - 0.7, 2.0 + 0.1 * (i % 7));
      const PointId id = map_.add_point(point);
      const auto pixel = geometry::project(camera_, truth_, point);
      measured_.points.push_back({id, pixel.value().cast<float>(), 0});
    }
    measured_.readout_twist = truth_.readout_twist;
  }

  std::optional<geometry::Pose> refine(const geometry::Pose& start) const {
    return refine_pose(camera_, map_.view(1), measured_, start);
  }

  geometry::Camera camera_ = testing::small_camera();
  geometry::FramePose truth_ =
      geometry::Pose(geometry::exp_so3({0.02, -0.1, 0.03}), {0.1, -0.05, 0.2});
  geometry::Pose near_{geometry::exp_so3({0.03, -0.11, 0.03}), {0.12, -0.04, 0.19}};
  Map map_;
  FrameMeasurements measured_;
};

TEST_F(PoseRefinement, FindsThePoseThatThePointsSay) {
  const auto refined = refine(near_.inverse());
  ASSERT_TRUE(refined);
  // 1e-6: pixels are kept as floats, good to 1e-5 of a pixel at a focal length of 270.
  EXPECT_LT((refined->inverse().translation - truth_.camera_from_world.translation).norm(), 1e-6);
  EXPECT_LT(refined->inverse().rotation.angularDistance(truth_.camera_from_world.rotation), 1e-6);
}

TEST_F(PoseRefinement, FollowsPointsThatACorrectionMoved) {
  const geometry::Pose correction(geometry::exp_so3({0.0, 0.01, 0.0}), {0.02, 0.0, -0.01});
  for (const auto& m : measured_.points)
    map_.point(m.point).position = correction * map_.point(m.point).position;
  const auto refined = refine(truth_.camera_from_world.inverse());
  ASSERT_TRUE(refined);
  const geometry::Pose expected = correction * truth_.camera_from_world.inverse();
  EXPECT_LT((refined->translation - expected.translation).norm(), 1e-6);
}

TEST_F(PoseRefinement, PointsThatAreGoneAreDoneWithoutUntilTooFewAreLeft) {
  for (PointId id = 0; id < 45; ++id) map_.remove_point(id);
  EXPECT_TRUE(refine(near_.inverse()));
  for (PointId id = 45; id < 55; ++id) map_.remove_point(id);
  EXPECT_FALSE(refine(near_.inverse())) << "less than half of what it was measured from";
}

TEST_F(PoseRefinement, NothingMeasuredIsNoPose) {
  measured_.points.clear();
  EXPECT_FALSE(refine(near_.inverse()));
}

}  // namespace
}  // namespace lumibox::tracking
