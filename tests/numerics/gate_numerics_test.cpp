#include <cmath>
#include <limits>
#include <numbers>

#include "lightfield/coverage.h"
#include "lightfield/light_field.h"
#include "numerics/trap.h"

namespace lumibox::lightfield {
namespace {

using GateNumerics = Trapped;
using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;
const Vector3d kSubject(0.3, -0.2, 2.0);
constexpr double kUlp = std::numeric_limits<double>::epsilon();

LightField with(const std::vector<Vector3d>& centers) {
  LightField light_field;
  light_field.set_subject({kSubject, 0.5});
  for (const Vector3d& center : centers) {
    Perspective perspective;
    perspective.world_from_camera.translation = center;
    light_field.add(perspective);
  }
  return light_field;
}

/// A few hundred directions, no two alike (Fibonacci's lattice).
std::vector<Vector3d> directions() {
  std::vector<Vector3d> all;
  for (int i = 0; i < 420; ++i) {
    const double z = (2.0 * i + 1.0) / 420.0 - 1.0;
    const double turn = i * kPi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    all.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
  }
  return all;
}

// The dot product of two unit vectors exceeds 1 by rounding for many of these, where acos would be
// NaN. An angle is known to the rounding of the coordinates over the distance: 1e-15 here, ten
// times that allowed.
TEST_F(GateNumerics, OneDirectionAtTwoDistancesIsAnAngleOfZero) {
  int above_one = 0;
  for (const Vector3d& d : directions()) {
    for (const double distance : {0.7, 1.0, 3.0, 1e3}) {
      const Vector3d near = kSubject + d;
      const Vector3d far = kSubject + distance * d;
      above_one += (near - kSubject).normalized().dot((far - kSubject).normalized()) > 1.0 ? 1 : 0;
      EXPECT_LT(angle_at_subject(near, kSubject, far), 1e-14);
      EXPECT_FALSE(with({near}).accepts(far, 1e-14));
    }
  }
  EXPECT_GT(above_one, 0);
}

TEST_F(GateNumerics, AntipodesAreAnAngleOfPi) {
  for (const Vector3d& d : directions()) {
    const double angle = angle_at_subject(kSubject + d, kSubject, kSubject - 3.0 * d);
    EXPECT_LE(angle, kPi);
    EXPECT_NEAR(angle, kPi, 1e-14);
  }
}

// The gate's threshold decides to 1e-14 rad, at small angles too, where acos only has 1e-8.
TEST_F(GateNumerics, ThresholdIsSharpAtSmallAngles) {
  const LightField light_field = with({kSubject + Vector3d::UnitX()});
  for (const double angle : {1e-9, 1e-6, 1e-3, 0.1}) {
    const Vector3d center = kSubject + 2.0 * Vector3d(std::cos(angle), std::sin(angle), 0.0);
    EXPECT_TRUE(light_field.accepts(center, angle - 1e-14)) << angle;
    EXPECT_FALSE(light_field.accepts(center, angle + 1e-14)) << angle;
  }
}

// At S there is no direction; beside it by one rounding there is one, whatever it is.
TEST_F(GateNumerics, CameraAtSAndARoundingBesideIt) {
  const LightField light_field = with({kSubject + Vector3d::UnitX()});
  EXPECT_FALSE(light_field.accepts(kSubject, 0.0));
  EXPECT_FALSE(dot_on_sphere({kSubject, 0.5}, kSubject));
  const Vector3d beside = kSubject + Vector3d(0.0, kUlp, 0.0);
  EXPECT_TRUE(light_field.accepts(beside, 0.1));
  const auto dot = dot_on_sphere({kSubject, 0.5}, beside);
  ASSERT_TRUE(dot);
  EXPECT_NEAR((*dot - kSubject).norm(), 0.5, 4 * kUlp);
  EXPECT_TRUE(light_field.nearest(kSubject));
}

// 420 perspectives, the thesis' largest capture, at one point: one of them decides.
TEST_F(GateNumerics, FourHundredAndTwentyPerspectivesAtOnePoint) {
  const Vector3d center = kSubject + Vector3d(0.3, 0.4, 1.2);
  const LightField light_field = with(std::vector<Vector3d>(420, center));
  EXPECT_FALSE(light_field.accepts(center, 0.0));
  EXPECT_EQ(light_field.nearest(center), 0);
  EXPECT_TRUE(light_field.accepts(kSubject - Vector3d(0.3, 0.4, 1.2), kPi - 1e-9));
}

// Angles, and so the gate, do not depend on the world's scale or place; 2e-12: coordinates of 1e3
// lose three digits of the difference to S.
TEST_F(GateNumerics, MovedAndScaledWorldGivesTheSameAngles) {
  const Vector3d shift(1e3, -2e3, 5e2);
  const auto all = directions();
  for (std::size_t i = 1; i < all.size(); ++i) {
    const double angle = angle_at_subject(all[i - 1], Vector3d::Zero(), all[i]);
    EXPECT_NEAR(angle_at_subject(all[i - 1] + shift, shift, all[i] + shift), angle, 2e-12);
    for (const double scale : {1e-6, 1e6}) {
      EXPECT_NEAR(angle_at_subject(scale * all[i - 1], Vector3d::Zero(), scale * all[i]), angle,
                  4e-16 * 10.0);
    }
  }
}

}  // namespace
}  // namespace lumibox::lightfield
