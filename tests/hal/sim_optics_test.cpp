#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "geometry/camera.h"
#include "hal/sim_scenes.h"

// Where things appear: the lens, glass and mirrors against the equations.
namespace lumibox::hal {
namespace {

using testing::ball_scene;
using testing::scene_of;

/// Centroid of the bright pixels of a picture at t = 0.
Eigen::Vector2d bright_spot(const std::string& text) {
  const auto scene = scene_of(text);
  const Image image = testing::frame_alone(scene, 0);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0.0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (image.at(x, y)[1] < 128) continue;
      sum += Eigen::Vector2d(x, y);
      weight += 1.0;
    }
  }
  EXPECT_GT(weight, 20.0);
  return sum / weight;
}

/// The camera of ball_scene looks along y: its x is the world's, its y the world's -z.
Eigen::Vector2d predicted(const std::string& text, const Eigen::Vector3d& ball) {
  const auto scene = scene_of(text);
  const geometry::Camera camera(scene->profile());
  return *camera.project(scene->world_from_camera(0.0).inverse() * ball);
}

TEST(SimOptics, BallAppearsWhereThePinholeCameraPredicts) {
  // Off the axis the outline of a ball is an ellipse a tenth of a pixel off its centre.
  for (const Eigen::Vector3d& ball :
       {Eigen::Vector3d(0.0, 2.0, 0.0), Eigen::Vector3d(0.7, 2.0, -0.5),
        Eigen::Vector3d(-0.9, 2.5, 0.8)}) {
    const std::string text = ball_scene(ball.x(), ball.y(), ball.z());
    EXPECT_LT((bright_spot(text) - predicted(text, ball)).norm(), 0.2) << ball.transpose();
  }
}

TEST(SimOptics, BallAppearsWhereTheDistortedCameraPredicts) {
  constexpr const char* kLens = R"(
[[effects]]
kind = "lens_distortion"
k1 = -0.25
k2 = 0.08
p1 = 0.002
p2 = -0.003
)";
  const Eigen::Vector3d ball(0.8, 2.0, 0.6);
  const std::string text = ball_scene(ball.x(), ball.y(), ball.z(), kLens);
  const Eigen::Vector2d straight = predicted(ball_scene(0, 2, 0), ball);
  EXPECT_GT((predicted(text, ball) - straight).norm(), 5.0);
  EXPECT_LT((bright_spot(text) - predicted(text, ball)).norm(), 0.2);
}

TEST(SimOptics, MirrorShowsTheBallBehindIt) {
  // A mirror at y = 3 shows a ball at y = -1 (behind the camera) where y = 7 would be.
  const std::string mirror = R"(
[[objects]]
name = "mirror"
shape = "quad"
size = [4.0, 4.0, 0.0]
at = [0.0, 3.0, 0.0]
turn_deg = [0.0, 90.0, 0.0]
mirror = 1.0
[[effects]]
kind = "reflection"
)";
  const std::string text = ball_scene(0.6, -1.0, 0.4, mirror);
  EXPECT_LT((bright_spot(text) - predicted(text, {0.6, 7.0, 0.4})).norm(), 0.2);
}

TEST(SimOptics, GlassSlabShiftsTheBallBySnellsLaw) {
  constexpr double kIor = 1.5;
  constexpr double kThickness = 0.8;
  const std::string slab = R"(
[[objects]]
name = "slab"
shape = "box"
size = [6.0, 0.8, 6.0]
at = [0.0, 1.2, 0.0]
glass_ior = 1.5
[[effects]]
kind = "refraction"
)";
  // tan(a) (depth - thickness) + tan(b) thickness = x with sin(a) = ior sin(b), by bisection.
  constexpr double kDepth = 2.5;
  constexpr double kBallX = 0.9;
  double low = 0.0;
  double high = 1.2;
  for (int i = 0; i < 60; ++i) {
    const double outside = 0.5 * (low + high);
    const double inside = std::asin(std::sin(outside) / kIor);
    const double x = std::tan(outside) * (kDepth - kThickness) + std::tan(inside) * kThickness;
    (x < kBallX ? low : high) = outside;
  }
  const double expected = 319.5 + 540.0 * std::tan(low);
  const Eigen::Vector2d seen = bright_spot(ball_scene(kBallX, kDepth, 0.0, slab));
  EXPECT_GT(expected, 319.5 + 540.0 * kBallX / kDepth + 15.0);
  EXPECT_NEAR(seen.x(), expected, 0.3);
  EXPECT_NEAR(seen.y(), 239.5, 0.1);
}

TEST(SimOptics, GlassBallIsABallLens) {
  const std::string glass = R"(
[[objects]]
name = "lens"
shape = "sphere"
size = [0.8, 0.8, 0.8]
at = [0.0, 2.0, 0.0]
glass_ior = 1.5
[[effects]]
kind = "refraction"
)";
  // On the axis light goes straight through.
  EXPECT_LT((bright_spot(ball_scene(0.0, 6.0, 0.0, glass)) - Eigen::Vector2d(319.5, 239.5)).norm(),
            0.1);
  // Near the axis: focal length n R / (2 (n - 1)) from the centre; the image stands upside down.
  constexpr double kFocal = 1.5 * 0.4 / (2.0 * 0.5);
  constexpr double kFromCamera = 2.0;
  constexpr double kToBall = 4.0;
  const double slope = 0.1 / (kFromCamera + kToBall - kFromCamera * kToBall / kFocal);
  const Eigen::Vector2d seen = bright_spot(ball_scene(0.1, 6.0, 0.0, glass));
  EXPECT_LT(slope, 0.0);
  EXPECT_NEAR(seen.x(), 319.5 + 540.0 * slope, 0.5);
}

}  // namespace
}  // namespace lumibox::hal
