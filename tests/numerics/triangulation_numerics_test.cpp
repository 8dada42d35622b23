#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "geometry/triangulation.h"
#include "numerics/trap.h"

namespace lumibox::geometry {
namespace {

using TriangulationNumerics = Trapped;
using Eigen::Vector3d;

Pose at(const Vector3d& centre) {
  return Pose(exp_so3({0.1, -0.2, 0.05}), centre).inverse();
}

// With bearings exact to rounding (1e-16), the depth's relative error is rounding over parallax;
// allowed: ten times that.
TEST_F(TriangulationNumerics, DepthIsAsGoodAsTheParallaxAllows) {
  const Pose a = at({0.0, 0.0, 0.0});
  const Pose b = at({1.0, 0.0, 0.0});
  for (const double parallax_deg : {10.0, 1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5}) {
    const double parallax = parallax_deg * std::numbers::pi / 180.0;
    const Vector3d point(0.5, 0.0, 0.5 / std::tan(0.5 * parallax));
    const Vector3d in_a = (a * point).normalized();
    const Vector3d in_b = (b * point).normalized();
    const auto two = triangulate(a, b, in_a, in_b);
    ASSERT_TRUE(two) << parallax_deg;
    EXPECT_LT((*two - point).norm(), 1e-15 / parallax * point.norm() * 10.0) << parallax_deg;
    EXPECT_NEAR(parallax_angle(a, b, point), parallax, 1e-15);
    const auto many = triangulate(std::vector<Pose>{a, b}, std::vector<Vector3d>{in_a, in_b});
    ASSERT_TRUE(many) << parallax_deg;
    EXPECT_LT((*many - point).norm(), 1e-15 / parallax * point.norm() * 10.0) << parallax_deg;
  }
}

TEST_F(TriangulationNumerics, ParallelRaysGiveNone) {
  const Pose a = at({0.0, 0.0, 0.0});
  const Pose b = at({1.0, 0.0, 0.0});
  const Vector3d forward(0.0, 0.0, 1.0);
  EXPECT_FALSE(triangulate(a, b, forward, forward));
  const Vector3d tilted = Vector3d(1e-9, 0.0, 1.0).normalized();
  EXPECT_FALSE(triangulate(a, b, tilted, forward));
}

TEST_F(TriangulationNumerics, IdenticalCentresGiveNone) {
  const Pose a = at({1e3, -2e3, 500.0});
  // The same centre, reached by a detour through another rotation: equal but for rounding.
  const Pose b = exp_se3((Vector6d() << 0, 0, 0, 0.1, 0.2, -0.1).finished()) * a;
  EXPECT_FALSE(triangulate(a, a, Vector3d(0.1, 0.0, 1.0).normalized(), Vector3d::UnitZ()));
  EXPECT_FALSE(triangulate(a, b, Vector3d(0.1, 0.0, 1.0).normalized(), Vector3d::UnitZ()));
}

TEST_F(TriangulationNumerics, PointsBehindGiveNone) {
  const Pose a(Eigen::Quaterniond::Identity(), Vector3d::Zero());
  const Pose b(Eigen::Quaterniond::Identity(), Vector3d(-1.0, 0.0, 0.0));
  const Vector3d point(0.5, 0.2, -3.0);  // the lines meet here, the rays do not
  EXPECT_FALSE(triangulate(a, b, -(a * point).normalized(), -(b * point).normalized()));
  EXPECT_FALSE(triangulate(a, b, (a * point).normalized(), -(b * point).normalized()));
  EXPECT_TRUE(triangulate(a, b, (a * point).normalized(), (b * point).normalized()));
}

TEST_F(TriangulationNumerics, RaysAlongTheBaselineGiveNone) {
  const Pose a(Eigen::Quaterniond::Identity(), Vector3d::Zero());
  const Pose b(Eigen::Quaterniond::Identity(), Vector3d(0.0, 0.0, -1.0));
  EXPECT_FALSE(triangulate(a, b, Vector3d::UnitZ(), Vector3d::UnitZ()));
}

TEST_F(TriangulationNumerics, NonFiniteInputGivesNone) {
  const Pose a;
  Pose b(Eigen::Quaterniond::Identity(), Vector3d(-1.0, 0.0, 0.0));
  const Vector3d ray = Vector3d(0.0, 0.1, 1.0).normalized();
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(triangulate(a, b, Vector3d(bad, 0.0, 1.0), ray));
    EXPECT_FALSE(triangulate(a, Pose(b.rotation, Vector3d(0.0, bad, 0.0)), ray, ray));
    EXPECT_FALSE(triangulate(std::vector<Pose>{a, b}, std::vector<Vector3d>{ray, {0, 0, bad}}));
  }
  EXPECT_FALSE(triangulate(std::vector<Pose>{a}, std::vector<Vector3d>{ray}));
  EXPECT_FALSE(triangulate(std::vector<Pose>{}, std::vector<Vector3d>{}));
}

}  // namespace
}  // namespace lumibox::geometry
