#include <Eigen/Geometry>
#include <cmath>

#include "geometry/camera.h"
#include "numerics/trap.h"

namespace lumibox::geometry {
namespace {

using CameraNumerics = Trapped;

config::CameraProfile webcam() {
  config::CameraProfile profile;
  profile.width = 640;
  profile.height = 480;
  profile.fx = 520.0;
  profile.fy = 525.0;
  profile.cx = 325.0;
  profile.cy = 235.0;
  return profile;
}

void expect_round_trip(const Camera& camera) {
  for (int v = 0; v < camera.height(); v += 7) {
    for (int u = 0; u < camera.width(); u += 7) {
      const Eigen::Vector2d pixel(u, v);
      const auto normalised = camera.unproject(pixel);
      ASSERT_TRUE(normalised) << u << ' ' << v;
      const auto back = camera.project(2.5 * normalised->homogeneous());
      ASSERT_TRUE(back) << u << ' ' << v;
      // 1e-6 px: a thousandth of the best corner localisation is 1e-5.
      ASSERT_LT((*back - pixel).norm(), 1e-6) << u << ' ' << v;
    }
  }
}

TEST_F(CameraNumerics, DistortionRoundTripOverTheWholeFrame) {
  config::CameraProfile barrel = webcam();
  barrel.k1 = -0.28;
  barrel.k2 = 0.09;
  barrel.p1 = 1e-3;
  barrel.p2 = -8e-4;
  expect_round_trip(Camera(barrel));
  config::CameraProfile pincushion = webcam();
  pincushion.k1 = 0.25;
  pincushion.k2 = -0.05;
  pincushion.k3 = 0.02;
  expect_round_trip(Camera(pincushion));
  expect_round_trip(Camera(webcam()));
}

// With k1 only, r (1 + k1 r^2) turns back at r^2 = -1 / (3 k1): beyond, two directions would share
// a pixel.
TEST_F(CameraNumerics, BeyondTheFoldIsAFailureValue) {
  config::CameraProfile profile = webcam();
  profile.k1 = -0.4;
  const Camera camera(profile);
  const double fold = std::sqrt(1.0 / 1.2);
  EXPECT_NEAR(camera.fold_radius2(), fold * fold, 1e-12);
  EXPECT_TRUE(camera.project({0.999 * fold, 0.0, 1.0}));
  EXPECT_FALSE(camera.project({1.001 * fold, 0.0, 1.0}));
  Eigen::Matrix<double, 2, 3> jacobian;
  EXPECT_FALSE(camera.project({1.001 * fold, 0.0, 1.0}, &jacobian));
  // The largest distorted radius is fold * 2/3; no direction maps outside.
  const double outermost = 325.0 + 520.0 * fold * 2.0 / 3.0;
  EXPECT_TRUE(camera.unproject({outermost - 0.5, 235.0}));
  EXPECT_FALSE(camera.unproject({outermost + 0.5, 235.0}));
}

TEST(CameraProjection, BehindAndOnTheImagePlaneIsAFailureValue) {
  const Camera camera(webcam());
  EXPECT_FALSE(camera.project({0.1, 0.1, 0.0}));
  EXPECT_FALSE(camera.project({0.1, 0.1, -1.0}));
}

}  // namespace
}  // namespace lumibox::geometry
