#include "app/orbit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "app/moments.h"

namespace lumibox::app {
namespace {

using testing::around_subject;

lightfield::LightField arc(double half_angle) {
  lightfield::LightField light_field;
  light_field.set_subject({Eigen::Vector3d::UnitZ(), 0.3});
  for (int i = -10; i <= 10; ++i) {
    lightfield::Perspective perspective;
    perspective.world_from_camera = around_subject(half_angle * i / 10.0);
    light_field.add(perspective);
  }
  return light_field;
}

TEST(Orbit, LooksAtTheSubjectFromWithinWhatWasRecorded) {
  const auto light_field = arc(0.6);
  double widest = 0.0;
  for (double phase = 0.0; phase < 6.3; phase += 0.1) {
    const auto pose = orbit_pose(light_field, phase);
    ASSERT_TRUE(pose);
    const Eigen::Vector3d subject_in_view = pose->inverse() * Eigen::Vector3d::UnitZ();
    EXPECT_TRUE(subject_in_view.isApprox(Eigen::Vector3d::UnitZ(), 1e-9)) << phase;
    const Eigen::Vector3d up = -(pose->rotation * Eigen::Vector3d::UnitY());
    EXPECT_GT(up.dot(-Eigen::Vector3d::UnitY()), 0.99) << "upright as the recorded ones";
    const double angle = lightfield::angle_at_subject(pose->translation, Eigen::Vector3d::UnitZ(),
                                                      Eigen::Vector3d::Zero());
    widest = std::max(widest, angle);
  }
  EXPECT_GT(widest, 0.2);
  EXPECT_LT(widest, 0.6);
}

TEST(Orbit, IsSoundForAFullRoundAndForASingleView) {
  for (double phase = 0.0; phase < 6.3; phase += 0.5) {
    EXPECT_TRUE(orbit_pose(arc(std::numbers::pi), phase)->matrix4().allFinite());
    EXPECT_TRUE(orbit_pose(arc(0.0), phase)->matrix4().isApprox(Eigen::Matrix4d::Identity(), 1e-9));
  }
}

TEST(Orbit, NeedsASubjectAndSomethingRecorded) {
  lightfield::LightField light_field;
  EXPECT_FALSE(orbit_pose(light_field, 0.0));
  light_field.set_subject({});
  EXPECT_FALSE(orbit_pose(light_field, 0.0));
}

}  // namespace
}  // namespace lumibox::app
