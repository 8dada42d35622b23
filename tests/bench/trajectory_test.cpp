#include "bench/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lumibox::bench {
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
  EXPECT_NEAR(error->rmse_percent.value(), 100.0 * error->rmse / 5.0, 1e-9);
}

TEST(Trajectory, OfAPlaceThatNeverMovesHasNoExtentToTakeAShareOf) {
  auto truth = helix(10);
  for (auto& pose : truth) pose.world_from_camera.translation = {1.0, 2.0, 3.0};
  const auto error = compare_trajectories(helix(10), truth);
  ASSERT_TRUE(error);
  EXPECT_FALSE(error->rmse_percent);
}

TEST(Trajectory, RotationErrorIsWhatIsLeftAfterTheWorldsTurn) {
  const auto truth = helix(40);
  auto estimate = truth;
  const Eigen::Quaterniond world_turn = geometry::exp_so3({0.4, 1.0, -0.3});
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const double error_rad = i % 2 == 0 ? 0.01 : -0.01;  // the world's turn cannot take both away
    auto& rotation = estimate[i].world_from_camera.rotation;
    rotation = world_turn * geometry::exp_so3({0.0, error_rad, 0.0}) * rotation;
  }
  const auto error = compare_trajectories(estimate, truth);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->rotation_rmse_deg, 0.01 * 180.0 / std::numbers::pi, 1e-6);
}

TEST(Trajectory, ErrorsByPoseAreThoseOfTheirTimes) {
  const auto truth = helix(200);
  auto estimate = truth;
  estimate[50].world_from_camera.translation.z() += 0.5;
  auto& turned = estimate[80].world_from_camera.rotation;
  turned = geometry::exp_so3({0.1, 0.0, 0.0}) * turned;
  const auto error = compare_trajectories(estimate, truth);
  ASSERT_TRUE(error);
  ASSERT_EQ(error->by_pose.size(), 200U);
  EXPECT_EQ(error->by_pose[50].timestamp_s, truth[50].timestamp_s);
  EXPECT_NEAR(error->by_pose[50].distance, 0.5, 0.02);
  EXPECT_LT(error->by_pose[80].distance, 0.02);
  EXPECT_NEAR(error->by_pose[80].rotation_deg, 0.1 * 180.0 / std::numbers::pi, 0.1);
  EXPECT_LT(error->by_pose[50].rotation_deg, 0.1);
}

TEST(Trajectory, SubjectErrorIsTheAngleSeenFromTheSubject) {
  // A ring of cameras around the subject, every other one displaced along the ring by 0.02 rad and
  // back: no similarity takes that away.
  std::vector<hal::StampedPose> truth;
  std::vector<hal::StampedPose> estimate;
  const auto on_ring = [](double angle) {
    return geometry::Pose(Eigen::Quaterniond::Identity(),
                          Eigen::Vector3d(2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.0));
  };
  for (int i = 0; i < 36; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 36.0;
    truth.push_back({0.1 * i, on_ring(angle)});
    estimate.push_back({0.1 * i, on_ring(angle + (i % 2 == 0 ? 0.02 : -0.02))});
  }
  const auto error = compare_trajectories(estimate, truth, Eigen::Vector3d::Zero().eval());
  ASSERT_TRUE(error && error->subject_rmse_deg);
  // The scale grows by 1 / cos 0.02, which moves no direction.
  EXPECT_NEAR(*error->subject_rmse_deg, 0.02 * 180.0 / std::numbers::pi, 1e-6);
  EXPECT_FALSE(compare_trajectories(estimate, truth)->subject_rmse_deg);
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
}  // namespace lumibox::bench
