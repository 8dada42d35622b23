#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/pose.h"
#include "numerics/trap.h"

namespace lumibox::geometry {
namespace {

using SimilarityNumerics = Trapped;
using Eigen::Matrix3d;
using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;
const double kAngles[] = {0.0,  1e-300, 1e-16, 1e-12, 1e-8, 1e-4,       1e-2,      0.1,
                          0.49, 0.51,   1.0,   2.0,   3.0,  kPi - 1e-4, kPi - 1e-8};
const double kGrowths[] = {0.0,  1e-300, 1e-16, -1e-12, 1e-8, -1e-8, 1e-4,
                           1e-2, -0.1,   0.49,  -0.51,  1.0,  -2.0,  5.0};

Vector7d twist_of(double angle, double growth) {
  Vector7d twist;
  twist << 0.3, -0.2, 0.9, angle * Vector3d(2.0, 1.0, -2.0) / 3.0, growth;
  return twist;
}

double difference(const Similarity& a, const Similarity& b) {
  return std::abs(a.scale - b.scale) + (a.rigid.matrix4() - b.rigid.matrix4()).norm();
}

// 1e-12: a thousand roundings of translations up to 30 (growth of e^5 over the mean).
TEST_F(SimilarityNumerics, LogUndoesExpAtEveryAngleAndScale) {
  for (const double angle : kAngles) {
    for (const double growth : kGrowths) {
      const Vector7d twist = twist_of(angle, growth);
      EXPECT_LT((log_sim3(exp_sim3(twist)) - twist).norm(), 1e-12) << angle << ' ' << growth;
    }
  }
}

// At pi and beyond the logarithm is that of the short way round; the similarity must agree, to
// 1e-12 of the largest entry.
TEST_F(SimilarityNumerics, ExpUndoesLogFromPiOn) {
  for (const double angle : {kPi, kPi + 1e-8, 4.0, 2.0 * kPi, 7.0, 100.0}) {
    for (const double growth : kGrowths) {
      const Similarity similarity = exp_sim3(twist_of(angle, growth));
      const Similarity back = exp_sim3(log_sim3(similarity));
      const double size = 1.0 + similarity.scale + similarity.rigid.translation.norm();
      EXPECT_LT(difference(back, similarity), 1e-12 * size) << angle << ' ' << growth;
    }
  }
}

// Both signs of a quaternion are one rotation.
TEST_F(SimilarityNumerics, SignOfTheQuaternionDoesNotMatter) {
  for (const double angle : kAngles) {
    Similarity similarity = exp_sim3(twist_of(angle, 0.3));
    const Vector7d twist = log_sim3(similarity);
    similarity.rigid.rotation.coeffs() *= -1.0;
    EXPECT_EQ(log_sim3(similarity), twist) << angle;
  }
}

// Scale 1 is SE(3): two ways of computing one thing, apart by roundings only.
TEST_F(SimilarityNumerics, WithoutGrowthItIsARigidTransform) {
  for (const double angle : kAngles) {
    const Vector7d twist = twist_of(angle, 0.0);
    const Similarity similarity = exp_sim3(twist);
    EXPECT_EQ(similarity.scale, 1.0);
    const Pose pose = exp_se3(twist.head<6>());
    EXPECT_LT((similarity.rigid.matrix4() - pose.matrix4()).norm(), 2e-15) << angle;
  }
}

// The definition: a thousandth of the way, a thousand times. The steps' roundings add up to 1e-13
// of the largest entry; allowed is ten times that.
TEST_F(SimilarityNumerics, IsTheLimitOfManySmallSteps) {
  for (const double angle : {0.0, 1e-8, 0.3, 3.0, 6.0}) {
    for (const double growth : {0.0, 1e-8, -1.0, 2.0}) {
      const Vector7d twist = twist_of(angle, growth);
      const Similarity step = exp_sim3(1e-3 * twist);
      Similarity product;
      for (int i = 0; i < 1000; ++i) product = step * product;
      EXPECT_LT(difference(product, exp_sim3(twist)), 1e-12 * std::exp(std::max(growth, 0.0)))
          << angle << ' ' << growth;
    }
  }
}

/// The mean of e^(sigma u) R(angle u) by Simpson's rule with long double, the axis being z.
Eigen::Matrix<long double, 3, 3> mean_by_quadrature(long double angle, long double sigma) {
  constexpr int kPieces = 8000;
  Eigen::Matrix<long double, 3, 3> sum = Eigen::Matrix<long double, 3, 3>::Zero();
  for (int i = 0; i <= kPieces; ++i) {
    const long double u = static_cast<long double>(i) / kPieces;
    const long double weight = i == 0 || i == kPieces ? 1.0L : (i % 2 == 1 ? 4.0L : 2.0L);
    const long double c = std::cos(angle * u);
    const long double s = std::sin(angle * u);
    Eigen::Matrix<long double, 3, 3> turned;
    turned << c, -s, 0.0L, s, c, 0.0L, 0.0L, 0.0L, 1.0L;
    sum += weight * std::exp(sigma * u) * turned;
  }
  return sum / (3.0L * kPieces);
}

// Against the integral itself in long double (Simpson's own error is 3e-16 here): 4e-15 is 20
// roundings of entries up to 3. The two forms of the mean meet at |z| = 0.5.
TEST_F(SimilarityNumerics, TranslationAgreesWithTheIntegralInLongDouble) {
  for (const double angle : {0.0, 1e-9, 1e-4, 0.3, 0.499, 0.501, 1.5, 3.1}) {
    for (const double growth : {0.0, 1e-9, -1e-4, 0.3, 0.499, -0.501, 1.5}) {
      const Matrix3d expected = mean_by_quadrature(angle, growth).cast<double>();
      for (int column = 0; column < 3; ++column) {
        Vector7d twist = Vector7d::Zero();
        twist[column] = 1.0;
        twist[5] = angle;
        twist[6] = growth;
        EXPECT_LT((exp_sim3(twist).rigid.translation - expected.col(column)).norm(), 4e-15)
            << angle << ' ' << growth;
      }
    }
  }
}

// A million products: the norm of the quaternion stays 1 to rounding. Scale and inverse are rounded
// the same way each time, so a million roundings, 1e-10, add up.
TEST_F(SimilarityNumerics, AMillionProductsDoNotDrift) {
  const Similarity there = exp_sim3(1e-3 * twist_of(1.0, 0.5));
  const Similarity back = there.inverse();
  Similarity product;
  for (int i = 0; i < 500'000; ++i) product = back * (there * product);
  EXPECT_NEAR(product.rigid.rotation.norm(), 1.0, 4 * std::numeric_limits<double>::epsilon());
  EXPECT_NEAR(product.scale, 1.0, 1e-10);
}

}  // namespace
}  // namespace lumibox::geometry
