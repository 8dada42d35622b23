#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/rotation.h"
#include "hal/sim/hand_path.h"

namespace lumibox::hal::sim {
namespace {

PathSpec serpentine() {
  PathSpec spec;
  spec.orbit = OrbitSpec{{-60.0, 60.0}, {10.0, 60.0}, 5, {0.6, 0.8}};
  spec.target = {0.1, -0.2, 0.3};
  spec.lead_in_s = 1.5;
  spec.lead_in_m = 0.15;
  return spec;
}

TEST(SimPath, WalkIsSmooth) {
  PathSpec spec = serpentine();
  spec.tremor = {.position_mm = 1.0, .rotation_deg = 0.2};
  const HandPath path(spec, 20.0);
  constexpr double kStep = 1e-3;
  for (double t = 0.1; t < 19.8; t += 0.013) {
    const Eigen::Vector3d before = path.world_from_camera(t - kStep).translation;
    const Eigen::Vector3d now = path.world_from_camera(t).translation;
    const Eigen::Vector3d after = path.world_from_camera(t + kStep).translation;
    EXPECT_LT((after - now).norm() / kStep, 1.0) << "metres per second at " << t;
    EXPECT_LT((after - 2.0 * now + before).norm() / (kStep * kStep), 8.0) << "m/s2 at " << t;
  }
}

TEST(SimPath, OrbitCoversItsAnglesAndLooksAtItsTarget) {
  const PathSpec spec = serpentine();
  const HandPath path(spec, 21.5);
  double most_left = 0.0, most_right = 0.0, lowest = 90.0, highest = 0.0;
  for (double t = 1.5; t <= 21.5; t += 0.02) {
    const geometry::Pose pose = path.world_from_camera(t);
    const Eigen::Vector3d out = pose.translation - spec.target;
    EXPECT_GT(out.norm(), 0.55);
    EXPECT_LT(out.norm(), 0.81);
    EXPECT_LT(geometry::angle_between(pose.matrix3().col(2), -out), 1e-6);
    EXPECT_LT(pose.matrix3()(2, 1), 0.0) << "the picture is upright";
    const double degrees = 180.0 / std::numbers::pi;
    const double azimuth = std::atan2(out.x(), -out.y()) * degrees;
    const double elevation = std::asin(out.z() / out.norm()) * degrees;
    most_left = std::min(most_left, azimuth);
    most_right = std::max(most_right, azimuth);
    lowest = std::min(lowest, elevation);
    highest = std::max(highest, elevation);
  }
  EXPECT_NEAR(most_left, -60.0, 2.0);
  EXPECT_NEAR(most_right, 60.0, 2.0);
  EXPECT_NEAR(lowest, 10.0, 1.0);
  EXPECT_NEAR(highest, 60.0, 1.0);
}

TEST(SimPath, TremorHasItsSizeAndFollowsItsSeed) {
  const WobbleSpec spec{.position_mm = 2.0, .rotation_deg = 0.5, .seed = 3};
  WobbleSpec other = spec;
  other.seed = 4;
  const Wobble wobble(spec);
  double position2 = 0.0, rotation2 = 0.0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const geometry::Pose pose = wobble.at(i * 0.0137);
    position2 += pose.translation.squaredNorm() / 3.0;
    rotation2 += geometry::log_so3(pose.rotation).squaredNorm() / 3.0;
  }
  EXPECT_NEAR(std::sqrt(position2 / kSamples), 2e-3, 1e-4);
  EXPECT_NEAR(std::sqrt(rotation2 / kSamples), 0.5 * std::numbers::pi / 180.0, 5e-4);
  EXPECT_EQ(wobble.at(1.0).translation, Wobble(spec).at(1.0).translation);
  EXPECT_NE(wobble.at(1.0).translation, Wobble(other).at(1.0).translation);
}

TEST(SimPath, ShakeIsViolentWhileItLastsAndLeavesTheWalkAlone) {
  PathSpec spec = serpentine();
  const HandPath steady(spec, 20.0);
  spec.shake = ShakeSpec{
      10.0, 0.5, {.position_mm = 10.0, .rotation_deg = 5.0, .min_hz = 3.0, .max_hz = 6.0}};
  const HandPath shaken(spec, 20.0);
  double most_deg = 0.0;
  for (double t = 0.0; t < 20.0; t += 0.01) {
    const geometry::Pose apart =
        steady.world_from_camera(t).inverse() * shaken.world_from_camera(t);
    const double turned_deg = geometry::log_so3(apart.rotation).norm() * 180.0 / std::numbers::pi;
    if (t < 10.0 || t > 10.5) {
      EXPECT_LT(apart.translation.norm() + turned_deg, 1e-9) << t;
    }
    most_deg = std::max(most_deg, turned_deg);
  }
  // Three axes of 5 degrees root mean square, of which half a second shows a part.
  EXPECT_GT(most_deg, 4.0);
}

TEST(SimPath, BeginsWithAStepSideways) {
  const HandPath path(serpentine(), 21.5);
  const geometry::Pose first = path.world_from_camera(0.1);
  const Eigen::Vector3d step = path.world_from_camera(1.2).translation - first.translation;
  const Eigen::Vector3d in_camera = first.matrix3().transpose() * step;
  EXPECT_GT(in_camera.x(), 0.09);
  EXPECT_LT(std::abs(in_camera.y()) + std::abs(in_camera.z()), 0.03);
}

}  // namespace
}  // namespace lumibox::hal::sim
