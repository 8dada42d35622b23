#include "app/guide.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>

#include "app/moments.h"
#include "geometry/rotation.h"

namespace lumibox::app {
namespace {

using testing::around_subject;

constexpr double kDegree = std::numbers::pi / 180.0;
const Eigen::Vector3d kSubject = Eigen::Vector3d::UnitZ();

lightfield::Perspective at(double angle) {
  lightfield::Perspective perspective;
  perspective.world_from_camera = around_subject(angle);
  return perspective;
}

TEST(Guide, SeesTheHoleAndThatItIsFilled) {
  Guide guide(60.0 * kDegree);
  lightfield::LightField light_field;
  EXPECT_EQ(guide.holes(light_field, 4.0 * kDegree).missing, 0);
  light_field.set_subject({kSubject, 0.3});
  for (int i = -8; i <= 8; ++i) {
    if (std::abs(i) > 3) light_field.add(at(5.0 * i * kDegree));
  }
  EXPECT_GT(guide.holes(light_field, 4.0 * kDegree).missing, 1);
  const Eigen::Vector3d middle = (around_subject(0.0).translation - kSubject).normalized();
  EXPECT_LT(geometry::angle_between(*guide.holes(light_field, 4.0 * kDegree).largest, middle),
            3.0 * kDegree);
  EXPECT_EQ(guide.holes(light_field, 25.0 * kDegree).missing, 0) << "with a larger gate";
  for (int i = -3; i <= 3; ++i) light_field.add(at(5.0 * i * kDegree));
  EXPECT_EQ(guide.holes(light_field, 4.0 * kDegree).missing, 0);
  light_field.wipe(light_field.nearest(kSubject - Eigen::Vector3d::UnitZ()).value());
  EXPECT_FALSE(light_field.perspectives().empty());
}

// around_subject(a) turns about the camera's y axis: to see S from a larger angle, go left.
TEST(WayTo, PointsWhereTheBoxMustBeMoved) {
  const auto towards = [](double angle) {
    return Eigen::Vector3d((around_subject(angle).translation - kSubject).normalized());
  };
  const auto left = way_to(towards(0.5), around_subject(0.2), kSubject, 4.0 * kDegree);
  ASSERT_TRUE(left);
  EXPECT_NEAR(left->x(), -1.0, 1e-6);
  const auto right = way_to(towards(-0.5), around_subject(0.2), kSubject, 4.0 * kDegree);
  ASSERT_TRUE(right);
  EXPECT_NEAR(right->x(), 1.0, 1e-6);
  const auto up = way_to(-Eigen::Vector3d::UnitY(), around_subject(0.2), kSubject, 4.0 * kDegree);
  ASSERT_TRUE(up);
  EXPECT_NEAR(up->y(), -1.0, 1e-6);
  EXPECT_FALSE(way_to(towards(0.22), around_subject(0.2), kSubject, 4.0 * kDegree)) << "there";
  EXPECT_FALSE(way_to(towards(0.5), {Eigen::Quaterniond::Identity(), kSubject}, kSubject, 0.1));
}

// A small step of the camera along the arrow brings it nearer, wherever it is and is turned.
RC_GTEST_PROP(WayTo, AStepAlongItComesNearer, ()) {
  const auto number = [] { return *rc::gen::inRange(-1000, 1001) * 1e-3; };
  const double x = number();
  const double y = number();
  const Eigen::Vector3d direction(x, y, number());
  RC_PRE(direction.norm() > 0.1);
  const double angle = 3.0 * number();
  const double roll = 3.0 * number();
  geometry::Pose camera = around_subject(angle);
  camera.rotation = camera.rotation * geometry::exp_so3({0.0, 0.0, roll});
  const auto way = way_to(direction.normalized(), camera, kSubject, 0.05);
  const Eigen::Vector3d before = camera.translation - kSubject;
  const double far = geometry::angle_between(before, direction);
  RC_ASSERT(way.has_value() || far < 0.05 || far > std::numbers::pi - 1e-3);
  if (!way) return;
  const Eigen::Vector3d step = camera.rotation * Eigen::Vector3d(way->x(), way->y(), 0.0);
  RC_ASSERT(geometry::angle_between(before + 0.01 * step, direction) < far - 0.005);
}

}  // namespace
}  // namespace lumibox::app
