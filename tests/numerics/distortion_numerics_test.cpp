#include <cmath>
#include <vector>

#include "geometry/camera.h"
#include "numerics/trap.h"
#include "numerics/webcam.h"

namespace lumibox::geometry {
namespace {

using DistortionNumerics = Trapped;

config::CameraProfile lens(double k1, double k2, double p1, double p2, double k3) {
  config::CameraProfile profile = webcam();
  profile.k1 = k1;
  profile.k2 = k2;
  profile.p1 = p1;
  profile.p2 = p2;
  profile.k3 = k3;
  return profile;
}

/// Webcams, a wide action camera, a pincushion, a decentred lens, and some whose fold lies within
/// the picture.
std::vector<config::CameraProfile> lenses() {
  return {lens(-0.28, 0.09, 1e-3, -8e-4, 0.0), lens(0.25, -0.05, 0.0, 0.0, 0.02),
          lens(-0.35, 0.15, 0.0, 0.0, -0.03),  lens(0.05, -0.2, 5e-3, -5e-3, 0.3),
          lens(-0.4, 0.0, 0.0, 0.0, 0.0),      lens(-0.9, 0.0, 0.0, 0.0, 0.0),
          lens(0.1, -0.9, 0.0, 0.0, 0.0),      lens(-0.5, 0.3, 0.0, 0.0, -0.1),
          lens(-0.4, 0.0, 0.03, 0.05, 0.0)};
}

// 1e-6 px: a thousandth of the best corner localisation is 1e-5. Every pixel either comes back or
// is refused; a direction inside the fold is always found again, but for the last per mille, where
// two solutions run together.
TEST_F(DistortionNumerics, EveryPixelComesBackOrIsRefused) {
  for (const config::CameraProfile& profile : lenses()) {
    const Camera camera(profile);
    for (int v = 0; v < 480; v += 3) {
      for (int u = 0; u < 640; u += 3) {
        const Eigen::Vector2d pixel(u, v);
        const auto n = camera.unproject(pixel);
        if (!n) continue;
        ASSERT_LT(n->squaredNorm(), camera.fold_radius2());
        const auto back = camera.project(n->homogeneous());
        ASSERT_TRUE(back) << u << ' ' << v;
        ASSERT_LT((*back - pixel).norm(), 1e-6) << u << ' ' << v;
      }
    }
  }
}

// Newton's method must find the direction, not just one with the same pixel. Its error is that of
// the pixel over the slope, which falls to 0 at the fold: 1e-12 over a slope of 1e-3.
TEST_F(DistortionNumerics, EveryDirectionInsideTheFoldIsFound) {
  for (const config::CameraProfile& profile : lenses()) {
    const Camera camera(profile);
    const double limit = std::min(0.999 * std::sqrt(camera.fold_radius2()), 1.5);
    for (int ring = 0; ring <= 100; ++ring) {
      const double r = limit * ring / 100.0;
      for (int spoke = 0; spoke < 24; ++spoke) {
        const double angle = spoke * 0.2618;
        const Eigen::Vector2d direction(r * std::cos(angle), r * std::sin(angle));
        const auto pixel = camera.project(direction.homogeneous());
        ASSERT_TRUE(pixel);
        const auto back = camera.unproject(*pixel);
        ASSERT_TRUE(back) << profile.k1 << ' ' << r;
        ASSERT_LT((*back - direction).norm(), 1e-9) << profile.k1 << ' ' << r;
      }
    }
  }
}

TEST_F(DistortionNumerics, BeyondTheFoldEveryDirectionIsRefused) {
  for (const config::CameraProfile& profile : lenses()) {
    const Camera camera(profile);
    const double fold = std::sqrt(camera.fold_radius2());
    if (!(fold < 10.0)) continue;
    for (const double beyond : {1.0 + 1e-9, 1.1, 2.0, 100.0}) {
      EXPECT_FALSE(camera.project({beyond * fold, 0.0, 1.0}));
      EXPECT_FALSE(camera.project({0.0, -beyond * fold, 1.0}));
    }
  }
}

// A decentred lens folds first on the side away from its decentring. There the derivative along the
// radius, by central differences of 1e-6 (good to 1e-9), reaches 0 at the fold and not before.
TEST_F(DistortionNumerics, ADecentredLensFoldsWhereItsDerivativeVanishes) {
  const config::CameraProfile profile = lens(-0.4, 0.0, 0.03, 0.05, 0.0);
  const Camera camera(profile);
  const Eigen::Vector2d away = -Eigen::Vector2d(profile.p2, profile.p1).normalized();
  const auto slope = [&](double r) {
    constexpr double kStep = 1e-6;
    const Eigen::Vector2d difference =
        camera.distort((r + kStep) * away) - camera.distort((r - kStep) * away);
    return away.dot(difference.cwiseQuotient(Eigen::Vector2d(profile.fx, profile.fy))) /
           (2.0 * kStep);
  };
  const double fold = std::sqrt(camera.fold_radius2());
  for (int i = 1; i < 100; ++i) EXPECT_GT(slope(0.01 * i * fold), 1e-3) << i;
  EXPECT_NEAR(slope(fold), 0.0, 1e-8);
  EXPECT_LT(fold, 0.9 / std::sqrt(1.2)) << "without the decentring: 1 / sqrt(3 * 0.4)";
}

// Central differences of step 1e-6 leave 1e-10 of second derivatives and 1e-7 px of rounding
// (600 px times 1e-16 over the step).
TEST_F(DistortionNumerics, JacobianAgreesWithCentralDifferences) {
  constexpr double kStep = 1e-6;
  for (const config::CameraProfile& profile : lenses()) {
    const Camera camera(profile);
    for (const double x : {-0.4, 0.0, 0.3}) {
      for (const double z : {0.1, 1.0, 10.0}) {
        const Eigen::Vector3d point = z * Eigen::Vector3d(x, 0.2, 1.0);
        Eigen::Matrix<double, 2, 3> jacobian;
        ASSERT_TRUE(camera.project(point, &jacobian));
        for (int i = 0; i < 3; ++i) {
          const Eigen::Vector3d step = kStep * z * Eigen::Vector3d::Unit(i);
          const Eigen::Vector2d difference =
              (*camera.project(point + step) - *camera.project(point - step)) / (2.0 * kStep * z);
          EXPECT_LT((jacobian.col(i) - difference).norm() * z, 1e-6);
        }
      }
    }
  }
}

// A point at any distance in front has a finite pixel and a finite derivative.
TEST_F(DistortionNumerics, PointsTowardsInfinityHaveFinitePixelsAndJacobians) {
  for (const config::CameraProfile& profile : lenses()) {
    const Camera camera(profile);
    for (const double distance : {1e-6, 1.0, 1e6, 1e12, 1e100, 1e300}) {
      Eigen::Matrix<double, 2, 3> jacobian;
      const auto pixel = camera.project(distance * Eigen::Vector3d(0.2, -0.1, 1.0), &jacobian);
      ASSERT_TRUE(pixel);
      EXPECT_LT((*pixel - camera.distort({0.2, -0.1})).norm(), 1e-12 * 640.0);
      EXPECT_LT(jacobian.norm() * distance, 1e4);
    }
  }
}

}  // namespace
}  // namespace lumibox::geometry
