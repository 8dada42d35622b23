#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/pose.h"
#include "numerics/trap.h"

namespace lumibox::geometry {
namespace {

using RotationNumerics = Trapped;
constexpr double kPi = std::numbers::pi;
const double kAngles[] = {0.0,  1e-16, 1e-14,      1e-12,      1e-10,      1e-9,        1e-8,
                          1e-7, 1e-6,  1e-5,       1e-4,       1e-3,       1e-2,        0.1,
                          1.0,  3.0,   kPi - 1e-4, kPi - 1e-6, kPi - 1e-8, kPi - 1e-10, kPi};

/// Unit vectors to the points of a cube's surface, 17 x 17 a face: its corners, the axes and the
/// diagonals are among them.
std::vector<Eigen::Vector3d> axes_on_a_fine_grid() {
  std::vector<Eigen::Vector3d> axes;
  for (int face = 0; face < 6; ++face) {
    for (int i = -8; i <= 8; ++i) {
      for (int j = -8; j <= 8; ++j) {
        Eigen::Vector3d v;
        v[face % 3] = face < 3 ? 1.0 : -1.0;
        v[(face + 1) % 3] = i / 8.0;
        v[(face + 2) % 3] = j / 8.0;
        axes.push_back(v.normalized());
      }
    }
  }
  return axes;
}

// 1e-12: a thousand roundings, far below any angle that a pixel resolves.
TEST_F(RotationNumerics, LogUndoesExpAtEveryAngleAxisAndSign) {
  for (const Eigen::Vector3d& axis : axes_on_a_fine_grid()) {
    for (const double angle : kAngles) {
      const Eigen::Quaterniond q = exp_so3(angle * axis);
      const Eigen::Quaterniond negative(-q.w(), -q.x(), -q.y(), -q.z());
      for (const Eigen::Vector3d& back : {log_so3(q), log_so3(negative)}) {
        // At pi both signs are the same rotation.
        const double error = std::min((back - angle * axis).norm(), (back + angle * axis).norm());
        ASSERT_LT(angle == kPi ? error : (back - angle * axis).norm(), 1e-12)
            << angle << " about " << axis.transpose();
      }
    }
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

// The derivative of exp at omega is the left Jacobian, which is also what turns the translation of
// a twist: exp(omega + d) = exp(J d) exp(omega). Central differences of step 1e-5 are good to 1e-10
// (step^2) and 1e-11 (rounding over step).
TEST_F(RotationNumerics, LeftJacobianAgreesWithCentralDifferences) {
  constexpr double kStep = 1e-5;
  const Eigen::Vector3d axis = Eigen::Vector3d(-1.0, 2.0, 2.0) / 3.0;
  for (const double angle : {0.0, 1e-16, 1e-8, 1e-4, 0.0099, 0.0101, 1.0, 3.0, kPi, 4.0, 6.0}) {
    const Eigen::Vector3d omega = angle * axis;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d unit = Eigen::Vector3d::Unit(k);
      const Eigen::Vector3d difference =
          log_so3(exp_so3(omega + kStep * unit) * exp_so3(omega - kStep * unit).conjugate()) /
          (2.0 * kStep);
      Vector6d twist;
      twist << unit, omega;
      EXPECT_LT((exp_se3(twist).translation - difference).norm(), 2e-10) << angle;
    }
  }
}

// A million products in each group; renormalised, the quaternion's norm stays 1 to rounding, and
// the matrix stays a rotation to twice that.
TEST_F(RotationNumerics, AMillionProductsStayRotations) {
  const Pose step(exp_so3({0.011, -0.023, 0.007}), Eigen::Vector3d(1e-3, 0.0, -1e-3));
  Pose pose;
  for (int i = 0; i < 1'000'000; ++i) pose = step * pose;
  EXPECT_NEAR(pose.rotation.norm(), 1.0, 3e-16);
  const Eigen::Matrix3d r = pose.matrix3();
  EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 2e-15);
  // A million turns by the same angle with the same rounding: 1e-16 each.
  const Eigen::Vector3d axis = Eigen::Vector3d(0.011, -0.023, 0.007).normalized();
  EXPECT_LT((pose.rotation * axis - axis).norm(), 1e-10);
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
