#include <cmath>
#include <numbers>

#include "geometry/pose.h"
#include "numerics/trap.h"

namespace lumibox::geometry {
namespace {

using RotationNumerics = Trapped;
constexpr double kPi = std::numbers::pi;
const double kAngles[] = {0.0,  1e-16, 1e-14,      1e-12,      1e-10,      1e-9,        1e-8,
                          1e-7, 1e-6,  1e-5,       1e-4,       1e-3,       1e-2,        0.1,
                          1.0,  3.0,   kPi - 1e-4, kPi - 1e-6, kPi - 1e-8, kPi - 1e-10, kPi};

// 1e-12: a thousand roundings, far below any angle that a pixel resolves.
TEST_F(RotationNumerics, LogUndoesExpAtEveryAngle) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  for (const double angle : kAngles) {
    const Eigen::Vector3d back = log_so3(exp_so3(angle * axis));
    // At pi both signs are the same rotation.
    const double error = std::min((back - angle * axis).norm(), (back + angle * axis).norm());
    EXPECT_LT(angle == kPi ? error : (back - angle * axis).norm(), 1e-12) << angle;
  }
}

// The small rotation must survive in relative terms: 1e-12 of 1e-16 is not noise of the result.
TEST_F(RotationNumerics, TinyRotationsKeepTheirRelativeAccuracy) {
  for (const double angle : {1e-16, 1e-12, 1e-8, 1e-4}) {
    const Eigen::Vector3d v = angle * Eigen::Vector3d(0.6, 0.0, -0.8);
    EXPECT_LT((log_so3(exp_so3(v)) - v).norm(), 1e-12 * angle) << angle;
  }
}

// Beyond pi the logarithm returns the short way round; the pose is what must agree, to 1e-12.
TEST_F(RotationNumerics, ExpUndoesLogBeyondPi) {
  for (const double angle : {kPi + 1e-8, 4.0, 6.0, 2.0 * kPi, 7.0, 100.0}) {
    Vector6d twist;
    twist << 0.3, -0.2, 0.9, angle * Eigen::Vector3d(2.0, 1.0, -2.0) / 3.0;
    const Pose pose = exp_se3(twist);
    const Pose back = exp_se3(log_se3(pose));
    EXPECT_LE(log_so3(pose.rotation).norm(), kPi + 1e-15);
    EXPECT_LT((back.matrix4() - pose.matrix4()).norm(), 1e-12) << angle;
  }
}

TEST_F(RotationNumerics, TwistComesBackAtEveryAngleBelowPi) {
  for (const double angle : kAngles) {
    if (angle >= kPi) continue;
    Vector6d twist;
    twist << 0.3, -0.2, 0.9, angle * Eigen::Vector3d(2.0, 1.0, -2.0) / 3.0;
    EXPECT_LT((log_se3(exp_se3(twist)) - twist).norm(), 1e-12) << angle;
  }
}

// acos of a dot product is wrong by 1e-8 at both ends and NaN beyond 1; this is right to rounding.
TEST_F(RotationNumerics, AngleBetweenIsExactAtBothEnds) {
  const Eigen::Vector3d a = Eigen::Vector3d(0.1, 0.7, -0.7).normalized();
  const Eigen::Vector3d across = a.unitOrthogonal();
  for (const double angle : {0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1.0}) {
    const Eigen::Vector3d b = std::cos(angle) * a + std::sin(angle) * across;
    EXPECT_NEAR(angle_between(a, b), angle, 4e-16);
    EXPECT_NEAR(angle_between(a, -b), kPi - angle, 1e-15);
    EXPECT_NEAR(angle_between(3.0 * a, 1e-5 * b), angle, 4e-16);
  }
  EXPECT_EQ(angle_between(a, Eigen::Vector3d::Zero()), 0.0);
}

// A thousand compositions may add up their roundings (1e-16 each), not amplify them.
TEST_F(RotationNumerics, LongProductsDoNotDrift) {
  Vector6d step;
  step << 1e-3, 2e-3, -1e-3, 0.01, -0.02, 0.005;
  Pose pose;
  for (int i = 0; i < 1000; ++i) pose = exp_se3(step) * pose;
  EXPECT_NEAR(pose.rotation.norm(), 1.0, 1e-15);
  EXPECT_LT((pose.matrix4() - exp_se3(1000.0 * step).matrix4()).norm(), 1e-11);
}

}  // namespace
}  // namespace lumibox::geometry
