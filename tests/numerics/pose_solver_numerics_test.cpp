#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "geometry/absolute_pose.h"
#include "geometry/p3p.h"
#include "geometry/two_view.h"
#include "geometry/two_view_scene.h"
#include "numerics/trap.h"

namespace lumibox::geometry {
namespace {

using PoseSolverNumerics = Trapped;
using Eigen::Vector3d;

constexpr double kSigma = 0.5 / 600.0;  // half a pixel at a focal length of 600

double best_p3p_error(const std::array<Vector3d, 3>& in_camera, const Pose& camera_from_world) {
  std::array<Vector3d, 3> points;
  std::array<Vector3d, 3> bearings;
  for (std::size_t i = 0; i < 3; ++i) {
    points[i] = camera_from_world.inverse() * in_camera[i];
    bearings[i] = in_camera[i].normalized();
  }
  double best = 1e9;
  for (const Pose& pose : solve_p3p(points, bearings)) {
    best = std::min(best, (pose.translation - camera_from_world.translation).norm());
  }
  return best;
}

TwoViewResult solve(const std::vector<BearingPair>& pairs) {
  return solve_two_view(pairs, TwoViewOptions{.sigma_rad = kSigma});
}

// Conditioning grows with (distance / size)^2: the error allowed is 1e-14 times its square, times
// the distance itself.
TEST_F(PoseSolverNumerics, P3pFarAway) {
  const Pose pose(exp_so3({0.3, -0.5, 0.2}), {0.1, 0.2, 0.3});
  for (const double distance : {3.0, 30.0, 300.0, 3000.0}) {
    const std::array<Vector3d, 3> points{Vector3d(-1.0, 0.3, distance),
                                         Vector3d(0.8, -0.7, distance + 0.4),
                                         Vector3d(0.3, 1.0, distance - 0.3)};
    EXPECT_LT(best_p3p_error(points, pose), 1e-14 * distance * distance * distance + 1e-12)
        << distance;
  }
}

TEST_F(PoseSolverNumerics, P3pFacingTheCamera) {
  // An equilateral triangle square to the axis has a double root; half the digits remain.
  const std::array<Vector3d, 3> points{Vector3d(1.0, 0.0, 4.0), Vector3d(-0.5, 0.8660254, 4.0),
                                       Vector3d(-0.5, -0.8660254, 4.0)};
  EXPECT_LT(best_p3p_error(points, Pose()), 1e-6);
}

TEST_F(PoseSolverNumerics, P3pDegenerateTriplesGiveNothing) {
  const Vector3d a(0.1, 0.2, 3.0);
  const Vector3d b(0.5, -0.2, 4.0);
  const std::array<Vector3d, 3> rays{a.normalized(), b.normalized(),
                                     Vector3d(0.3, 0.3, 1.0).normalized()};
  EXPECT_TRUE(solve_p3p({a, b, 0.5 * (a + b)}, rays).empty());  // collinear
  EXPECT_TRUE(solve_p3p({a, b, b}, rays).empty());              // repeated
  EXPECT_TRUE(solve_p3p({a, a, a}, rays).empty());
  EXPECT_TRUE(solve_p3p({a, b, Vector3d(1.0, 1.0, 3.0)}, {rays[0], rays[1], rays[1]}).empty());
}

// A planar or almost planar target is nothing special for P3P; 0.01 is five standard deviations of
// the pose at this noise and distance.
TEST_F(PoseSolverNumerics, AbsolutePoseOfPlanarAndNearlyPlanarPoints) {
  for (const double thickness : {0.0, 1e-9, 1e-4}) {
    TwoViewScene scene(5);
    const Pose pose(exp_so3({0.1, 0.4, -0.2}), {0.2, 0.1, 0.3});
    std::vector<Vector3d> points;
    std::vector<Vector3d> bearings;
    for (Vector3d p : scene.on_plane(60, Vector3d(0.2, 0.1, -1.0).normalized(), -3.0)) {
      p += thickness * scene.direction();
      bearings.push_back(scene.look(p, kSigma));
      points.push_back(pose.inverse() * p);
    }
    const auto found = solve_absolute_pose(points, bearings, 4.0 * kSigma, 1);
    ASSERT_TRUE(found);
    EXPECT_LT((found->camera_from_world.translation - pose.translation).norm(), 0.01);
    EXPECT_GE(found->inlier_count, 55);
  }
}

TEST_F(PoseSolverNumerics, AbsolutePoseOfCollinearOrTooFewPointsIsNone) {
  std::vector<Vector3d> points;
  std::vector<Vector3d> bearings;
  for (int i = 0; i < 30; ++i) {
    points.push_back(Vector3d(0.1 * i - 1.5, 0.2, 4.0));
    bearings.push_back(points.back().normalized());
  }
  EXPECT_FALSE(solve_absolute_pose(points, bearings, 1e-3, 1));
  points.resize(3);
  bearings.resize(3);
  EXPECT_FALSE(solve_absolute_pose(points, bearings, 1e-3, 1));
  points.clear();
  EXPECT_FALSE(solve_absolute_pose(points, bearings, 1e-3, 1));
}

// With the true noise, no sample of 20 scenes may claim a translation.
TEST_F(PoseSolverNumerics, TurningOnTheSpotIsRotationOnly) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    TwoViewScene scene(seed);
    const Pose turn(exp_so3(0.1 * scene.direction()), Vector3d::Zero());
    auto pairs = scene.observe(scene.volume(200, 2.0, 6.0), turn, kSigma);
    scene.spoil(&pairs, 40);
    const TwoViewResult result = solve(pairs);
    EXPECT_EQ(result.outcome, TwoViewOutcome::RotationOnly) << seed;
    // 0.5 px over 160 pairs gives 1e-4 rad per axis, 3e-4 about the line of sight; four times that.
    EXPECT_LT(result.second_from_first.rotation.angularDistance(turn.rotation), 1.2e-3) << seed;
  }
}

TEST_F(PoseSolverNumerics, StandingStillIsNoMotion) {
  for (const double sigma : {0.0, kSigma}) {
    TwoViewScene scene(3);
    EXPECT_EQ(solve(scene.observe(scene.volume(200, 2.0, 6.0), Pose(), sigma)).outcome,
              TwoViewOutcome::NoMotion);
  }
}

// A plane has up to two explanations; the true one must be among those returned, within 2 degrees.
TEST_F(PoseSolverNumerics, ExactPlaneKeepsTheTrueMotionAmongTheCandidates) {
  int ambiguous = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    TwoViewScene scene(seed);
    const Vector3d normal =
        Vector3d(scene.uniform(-0.5, 0.5), scene.uniform(-0.5, 0.5), -1.0).normalized();
    const Pose motion(exp_so3(0.1 * scene.direction()), 0.3 * scene.direction());
    const auto points = scene.on_plane(200, normal, -2.0);
    for (const double sigma : {0.0, kSigma}) {
      const TwoViewResult result = solve(scene.observe(points, motion, sigma));
      EXPECT_TRUE(result.planar) << seed;
      ASSERT_FALSE(result.candidates.empty()) << seed;
      double nearest = 4.0;
      for (const Pose& candidate : result.candidates) {
        nearest = std::min(nearest, angle_between(candidate.translation, motion.translation));
      }
      EXPECT_LT(nearest, 0.035) << seed;
      ambiguous += result.outcome == TwoViewOutcome::PlaneAmbiguous ? 1 : 0;
    }
  }
  EXPECT_GT(ambiguous, 0);
}

TEST_F(PoseSolverNumerics, CollinearCoincidentAndRepeatedPointsAreRefused) {
  const Pose motion(exp_so3({0.02, 0.05, 0.0}), {0.3, 0.0, 0.05});
  TwoViewScene scene(4);
  std::vector<Vector3d> line;
  for (int i = 0; i < 60; ++i) line.push_back(Vector3d(0.03 * i - 0.9, 0.2, 4.0 + 0.02 * i));
  const std::vector<Vector3d> same(60, Vector3d(0.1, 0.2, 3.0));
  std::vector<Vector3d> three;
  for (int i = 0; i < 60; ++i) three.push_back(line[static_cast<std::size_t>(20 * (i % 3))]);
  for (const double sigma : {0.0, kSigma}) {
    EXPECT_NE(solve(scene.observe(line, motion, sigma)).outcome, TwoViewOutcome::Ok);
    EXPECT_NE(solve(scene.observe(same, motion, sigma)).outcome, TwoViewOutcome::Ok);
    EXPECT_NE(solve(scene.observe(three, motion, sigma)).outcome, TwoViewOutcome::Ok);
  }
}

// Up to half wrong matches the motion is found; beyond, it is found or refused, never wrong. 0.15
// rad: the direction of a 0.3 step, at depths of 2 to 6, is uncertain by a few hundredths.
TEST_F(PoseSolverNumerics, OutliersFromNoneToNineTenths) {
  for (const int percent : {0, 10, 30, 50, 70, 90}) {
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
      TwoViewScene scene(seed);
      const Pose motion(exp_so3(0.1 * scene.direction()), 0.3 * scene.direction());
      auto pairs = scene.observe(scene.volume(200, 2.0, 6.0), motion, kSigma);
      scene.spoil(&pairs, 2 * percent);
      const TwoViewResult result = solve(pairs);
      EXPECT_TRUE(percent > 50 || result.outcome == TwoViewOutcome::Ok) << percent << ' ' << seed;
      if (result.outcome != TwoViewOutcome::Ok) continue;
      EXPECT_LT(angle_between(result.second_from_first.translation, motion.translation), 0.15)
          << percent << ' ' << seed;
    }
  }
}

TEST_F(PoseSolverNumerics, FewPointsAreRefused) {
  for (const int count : {0, 1, 3, 5, 7}) {
    TwoViewScene scene(1);
    const Pose motion(exp_so3({0.0, 0.1, 0.0}), {0.3, 0.0, 0.0});
    const auto pairs = scene.observe(scene.volume(count, 2.0, 6.0), motion, 0.0);
    EXPECT_EQ(solve(pairs).outcome, TwoViewOutcome::TooFewPoints);
    // Even where the caller asks for no minimum, nothing breaks.
    const TwoViewResult result =
        solve_two_view(pairs, TwoViewOptions{.sigma_rad = kSigma, .min_inliers = 0});
    EXPECT_EQ(result.outcome == TwoViewOutcome::TooFewPoints, count < 5);
    EXPECT_EQ(result.inliers.size(), pairs.size());
  }
}

}  // namespace
}  // namespace lumibox::geometry
