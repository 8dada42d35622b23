#include <Eigen/Geometry>
#include <cmath>

#include "geometry/camera.h"
#include "numerics/trap.h"
#include "numerics/webcam.h"

namespace lumibox::geometry {
namespace {

using CameraNumerics = Trapped;

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

/// 126 degrees across the width, 160 from corner to corner.
config::CameraProfile fisheye() {
  config::CameraProfile profile = webcam();
  profile.model = config::LensModel::Fisheye;
  profile.fx = 290.0;
  profile.fy = 291.0;
  profile.k1 = -0.02;
  profile.k2 = 0.006;
  profile.k3 = -0.003;
  profile.k4 = 0.0004;
  return profile;
}

TEST_F(CameraNumerics, FisheyeRoundTripOverTheWholeFrame) {
  expect_round_trip(Camera(fisheye()));
  expect_round_trip(Camera(fisheye()).at_level(2));
  config::CameraProfile equidistant = fisheye();
  equidistant.k1 = equidistant.k2 = equidistant.k3 = equidistant.k4 = 0.0;
  expect_round_trip(Camera(equidistant));
}

// The numbers are those of cv::fisheye::projectPoints (OpenCV 4.6).
TEST_F(CameraNumerics, FisheyeIsOpenCvs) {
  const Camera camera(fisheye());
  EXPECT_LT(
      (*camera.project({0.3, -0.2, 1}) - Eigen::Vector2d(408.306033387, 179.271136286)).norm(),
      1e-8);
  EXPECT_LT((*camera.project({-4, 1, 1.5}) - Eigen::Vector2d(-10.348695666, 319.126267620)).norm(),
            1e-8);
  EXPECT_LT((*camera.project({0, 0.5, 0.2}) - Eigen::Vector2d(325.000000000, 573.334302338)).norm(),
            1e-8);
}

TEST_F(CameraNumerics, FisheyeJacobianIsTheDerivative) {
  const Camera camera(fisheye());
  constexpr double kStep = 1e-6;
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(0.0, 0.0, 2.0), Eigen::Vector3d(1e-9, 0.0, 1.0),
        Eigen::Vector3d(0.3, -0.2, 1.0), Eigen::Vector3d(-4.0, 1.0, 1.5)}) {
    Eigen::Matrix<double, 2, 3> jacobian;
    const auto pixel = camera.project(point, &jacobian);
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - *camera.project(point)).norm(), 1e-12);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector2d slope =
          (*camera.project(point + step) - *camera.project(point - step)) / (2.0 * kStep);
      EXPECT_LT((slope - jacobian.col(axis)).norm(), 1e-6) << point.transpose() << ' ' << axis;
    }
  }
}

TEST_F(CameraNumerics, FisheyeBeyondTheFoldIsAFailureValue) {
  config::CameraProfile profile = fisheye();
  profile.k1 = -0.3;
  profile.k2 = profile.k3 = profile.k4 = 0.0;
  const Camera camera(profile);
  const double fold = std::sqrt(1.0 / 0.9);  // 1 + 3 k1 theta^2 = 0
  EXPECT_TRUE(camera.project({std::tan(fold - 1e-3), 0.0, 1.0}));
  EXPECT_FALSE(camera.project({std::tan(fold + 1e-3), 0.0, 1.0}));
  const double outermost = 325.0 + 290.0 * fold * 2.0 / 3.0;
  EXPECT_TRUE(camera.unproject({outermost - 0.5, 235.0}));
  EXPECT_FALSE(camera.unproject({outermost + 0.5, 235.0}));
}

// 200 degrees: the outermost pixels look backwards, which normalised coordinates cannot say.
TEST_F(CameraNumerics, FisheyeThatSeesBehindItselfIsAFailureValueThere) {
  config::CameraProfile profile = fisheye();
  profile.fx = profile.fy = 180.0;
  profile.k1 = profile.k2 = profile.k3 = profile.k4 = 0.0;
  const Camera camera(profile);
  const double edge = 180.0 * 1.5707963;  // 90 degrees from the axis
  EXPECT_TRUE(camera.unproject({325.0 + edge - 0.5, 235.0}));
  EXPECT_FALSE(camera.unproject({325.0 + edge + 0.5, 235.0}));
  EXPECT_FALSE(camera.project({1.0, 0.0, 1e-4}));
  EXPECT_FALSE(camera.project({1.0, 0.0, -0.1}));
}

TEST_F(CameraNumerics, FisheyeWithoutDistortionIsAPinhole) {
  const Camera pinhole = Camera(fisheye()).undistorted();
  EXPECT_FALSE(pinhole.has_distortion());
  EXPECT_EQ(pinhole.project({1.0, 0.0, 1.0})->x(), 325.0 + 290.0);
}

TEST(CameraProjection, BehindAndOnTheImagePlaneIsAFailureValue) {
  const Camera camera(webcam());
  EXPECT_FALSE(camera.project({0.1, 0.1, 0.0}));
  EXPECT_FALSE(camera.project({0.1, 0.1, -1.0}));
}

}  // namespace
}  // namespace lumibox::geometry
