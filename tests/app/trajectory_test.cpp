#include "app/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lumibox::app {
namespace {

std::vector<hal::StampedPose> helix(int count) {
  std::vector<hal::StampedPose> poses;
  for (int i = 0; i < count; ++i) {
    const double t = 0.1 * i;
    poses.push_back({t, {Eigen::Quaterniond::Identity(), {std::cos(t), std::sin(t), 0.2 * t}}});
  }
  return poses;
}

TEST(Trajectory, ScalePlaceAndTurnOfTheWorldDoNotCount) {
  const auto truth = helix(50);
  auto estimate = truth;
  const geometry::Similarity moved{
      3.0, {geometry::exp_so3({0.3, -0.2, 0.9}), Eigen::Vector3d(5.0, 6.0, 7.0)}};
  for (auto& pose : estimate) {
    pose.timestamp_s += 0.004;
    pose.world_from_camera = moved * pose.world_from_camera;
  }
  const auto error = compare_trajectories(estimate, truth);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->poses, 50);
  EXPECT_LT(error->rmse, 1e-9);
  EXPECT_NEAR(error->truth_from_estimate.scale, 1.0 / 3.0, 1e-9);
}

TEST(Trajectory, ErrorIsInTheTruthsUnitsAndAShareOfItsExtent) {
  // Four corners of a square, two of them half a unit too high and two too low: no similarity
  // helps.
  std::vector<hal::StampedPose> truth;
  std::vector<hal::StampedPose> estimate;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d corner(i % 2 * 3.0, i / 2 * 4.0, 0.0);
    const double up = (i % 2 == i / 2) ? 0.5 : -0.5;
    truth.push_back({1.0 * i, {Eigen::Quaterniond::Identity(), corner}});
    estimate.push_back(
        {1.0 * i, {Eigen::Quaterniond::Identity(), corner + Eigen::Vector3d(0.0, 0.0, up)}});
  }
  const auto error = compare_trajectories(estimate, truth);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->rmse, 0.5, 0.01);
  EXPECT_NEAR(error->rmse_percent, 100.0 * error->rmse / 5.0, 1e-9);
}

TEST(Trajectory, PosesWithoutATruthOfTheirTimeAreLeftOut) {
  auto estimate = helix(10);
  for (auto& pose : estimate) {
    pose.timestamp_s += 0.05;
  }
  EXPECT_FALSE(compare_trajectories(estimate, helix(10)));
  EXPECT_FALSE(compare_trajectories(helix(2), helix(10)));
  EXPECT_FALSE(compare_trajectories(helix(10), {}));
  EXPECT_EQ(compare_trajectories(helix(20), helix(5))->poses, 5);
}

}  // namespace
}  // namespace lumibox::app
