#include "geometry/two_view.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "geometry/essential.h"
#include "geometry/homography.h"
#include "geometry/two_view_scene.h"

namespace lumibox::geometry {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSigma = 0.5 / 600.0;

// 1e-6: the worst of a thousand random samples of five is 1e-9.
RC_GTEST_PROP(Essential, FivePairsYieldTheTrueMatrix, (std::uint32_t seed)) {
  TwoViewScene scene(seed);
  const Pose motion(exp_so3(0.3 * scene.direction()), scene.direction());
  const auto pairs = scene.observe(scene.volume(5, 2.0, 6.0), motion, 0.0);
  const Matrix3d truth = essential_from_motion(motion);
  double nearest = 1e9;
  for (const Matrix3d& e : solve_essential({pairs[0], pairs[1], pairs[2], pairs[3], pairs[4]})) {
    nearest = std::min({nearest, (e - truth).norm(), (e + truth).norm()});
  }
  RC_ASSERT(nearest < 1e-6);
}

TEST(Essential, RepeatedPairsAreHarmless) {
  const BearingPair pair{Vector3d::UnitZ(), Vector3d(0.0, 0.6, 0.8)};
  for (const Matrix3d& e : solve_essential({pair, pair, pair, pair, pair})) {
    EXPECT_TRUE(e.allFinite());
  }
}

TEST(Homography, ThatAPlaneInducesIsFittedAndTakenApart) {
  TwoViewScene scene(7);
  const Vector3d normal = Vector3d(0.3, -0.2, -1.0).normalized();
  const Pose motion(exp_so3({0.1, -0.05, 0.2}), Vector3d(0.4, 0.1, -0.2));
  const auto pairs = scene.observe(scene.on_plane(20, normal, -2.5), motion, 0.0);
  const auto fitted = fit_homography(pairs);
  ASSERT_TRUE(fitted);
  const Matrix3d truth = motion.matrix3() + motion.translation * normal.transpose() / -2.5;
  EXPECT_LT((*fitted / fitted->norm() - truth / truth.norm()).norm(), 1e-9);
  double nearest = 4.0;
  for (const PlaneMotion& option : motions_of_homography(*fitted, pairs)) {
    nearest =
        std::min(nearest, angle_between(option.second_from_first.translation, motion.translation) +
                              option.second_from_first.rotation.angularDistance(motion.rotation) +
                              angle_between(option.normal, -normal));
  }
  EXPECT_LT(nearest, 1e-6);
}

TEST(TwoView, GeneralMotionIsFoundWithItsPoints) {
  TwoViewScene scene(11);
  const Pose motion(exp_so3({0.02, 0.1, 0.0}), Vector3d(-0.5, 0.05, 0.1));
  const auto points = scene.volume(300, 2.0, 6.0);
  auto pairs = scene.observe(points, motion, kSigma);
  scene.spoil(&pairs, 60);
  const auto result = solve_two_view(pairs, {.sigma_rad = kSigma});
  ASSERT_EQ(result.outcome, TwoViewOutcome::Ok);
  EXPECT_FALSE(result.planar);
  // Sideways by 0.5 at a depth of 4: direction good to half a degree.
  EXPECT_LT(angle_between(result.second_from_first.translation, motion.translation), 0.02);
  EXPECT_NEAR(result.second_from_first.translation.norm(), 1.0, 1e-12);
  EXPECT_GT(result.inlier_count, 210);
  const double scale = motion.translation.norm();
  for (std::size_t i = 60; i < pairs.size(); ++i) {
    if (!result.inliers[i]) continue;
    // Depth noise is depth^2 / baseline * sigma: 6 % at the far end; five times that.
    EXPECT_LT((scale * *result.points[i] - points[i]).norm(), 0.3 * points[i].norm());
  }
}

TEST(TwoView, SameSeedGivesTheSameResult) {
  TwoViewScene scene(12);
  auto pairs = scene.observe(scene.volume(100, 2.0, 6.0),
                             Pose(exp_so3({0.0, 0.1, 0.0}), {0.5, 0.0, 0.0}), kSigma);
  scene.spoil(&pairs, 30);
  const auto a = solve_two_view(pairs, {.sigma_rad = kSigma, .seed = 9});
  const auto b = solve_two_view(pairs, {.sigma_rad = kSigma, .seed = 9});
  EXPECT_EQ(a.second_from_first.matrix4(), b.second_from_first.matrix4());
  EXPECT_EQ(a.inliers, b.inliers);
}

TEST(TwoView, OrderOfThePairsDoesNotMatter) {
  TwoViewScene scene(13);
  const Pose motion(exp_so3({0.0, 0.1, 0.0}), {0.5, 0.0, 0.0});
  auto pairs = scene.observe(scene.volume(150, 2.0, 6.0), motion, kSigma);
  const auto forwards = solve_two_view(pairs, {.sigma_rad = kSigma});
  std::ranges::reverse(pairs);
  const auto backwards = solve_two_view(pairs, {.sigma_rad = kSigma});
  EXPECT_EQ(forwards.outcome, backwards.outcome);
  // Different samples, same optimum: within a fifth of the noise of the estimate.
  EXPECT_LT(angle_between(forwards.second_from_first.translation,
                          backwards.second_from_first.translation),
            0.02);
}

TEST(TwoView, SmallStepIsLowParallax) {
  TwoViewScene scene(14);
  const Pose motion(exp_so3({0.0, 0.02, 0.0}), {0.04, 0.0, 0.0});
  const auto pairs = scene.observe(scene.volume(200, 3.0, 6.0), motion, kSigma);
  EXPECT_EQ(solve_two_view(pairs, {.sigma_rad = kSigma}).outcome, TwoViewOutcome::LowParallax);
}

}  // namespace
}  // namespace lumibox::geometry
