#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "numerics/bundle_scene.h"
#include "numerics/trap.h"

namespace lumibox::tracking {
namespace {

using BundleNumerics = Trapped;
using Eigen::Vector3d;

bool is_finite(const BundleProblem& problem) {
  const auto fine = [](const Vector3d& v) { return v.cwiseAbs().maxCoeff() < 1e30; };
  return std::ranges::all_of(problem.points, fine) &&
         std::ranges::all_of(problem.views, [&](const auto& view) {
           return fine(view.camera_from_world.translation) &&
                  std::abs(view.camera_from_world.rotation.norm() - 1.0) < 1e-12;
         });
}

Eigen::VectorXd residuals(const geometry::Camera& camera, const BundleProblem& problem) {
  Eigen::VectorXd all(2 * static_cast<Eigen::Index>(problem.observations.size()));
  Eigen::Index row = 0;
  for (const auto& o : problem.observations) {
    const auto pixel =
        camera.project(problem.views[static_cast<std::size_t>(o.view)].camera_from_world *
                       problem.points[static_cast<std::size_t>(o.point)]);
    all.segment<2>(row) = *pixel - o.pixel;
    row += 2;
  }
  return all;
}

/// By twists of the views from the left, then by points: central differences.
Eigen::MatrixXd numerical_jacobian(const geometry::Camera& camera, const BundleProblem& problem) {
  constexpr double kStep = 1e-5;
  const auto views = static_cast<Eigen::Index>(problem.views.size());
  const auto points = static_cast<Eigen::Index>(problem.points.size());
  Eigen::MatrixXd jacobian(2 * static_cast<Eigen::Index>(problem.observations.size()),
                           6 * views + 3 * points);
  const auto shifted = [&](Eigen::Index column, double step) {
    BundleProblem p = problem;
    if (column < 6 * views) {
      auto& pose = p.views[static_cast<std::size_t>(column / 6)].camera_from_world;
      pose = geometry::exp_se3(step * geometry::Vector6d::Unit(column % 6)) * pose;
    } else {
      p.points[static_cast<std::size_t>((column - 6 * views) / 3)][(column - 6 * views) % 3] +=
          step;
    }
    return residuals(camera, p);
  };
  for (Eigen::Index c = 0; c < jacobian.cols(); ++c) {
    jacobian.col(c) = (shifted(c, kStep) - shifted(c, -kStep)) / (2.0 * kStep);
  }
  return jacobian;
}

// Seven directions change no residual: rotation, translation and scale of the world. Central
// differences leave 1e-8 of a column (the step's square and rounding over the step), so their
// eigenvalues are below 1e-14 of the largest; the next, depth of points, is above 1e-7.
TEST_F(BundleNumerics, GaugeFreedomIsExactlySeven) {
  const geometry::Camera camera;
  const BundleProblem problem = bundle_scene(camera, 4, 20, 0.0);
  const Eigen::MatrixXd jacobian = numerical_jacobian(camera, problem);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(jacobian.transpose() * jacobian,
                                                             Eigen::EigenvaluesOnly);
  const Eigen::VectorXd relative = eigen.eigenvalues() / eigen.eigenvalues().maxCoeff();
  EXPECT_LT(relative[6], 1e-14);
  EXPECT_GT(relative[7], 1e-7);
}

// Without a fixed view the normal matrix has those seven zeros. The solver must stay where it is
// along them, and the rest be found: after alignment at most 5 % of the perturbation are left.
TEST_F(BundleNumerics, WithoutAFixedViewTheShapeIsRecovered) {
  const geometry::Camera camera;
  BundleProblem truth = bundle_scene(camera, 5, 60, 0.0);
  for (auto& view : truth.views) view.fixed = false;
  const BundleProblem start = perturbed(truth, 0.02);
  BundleProblem found = start;
  ASSERT_TRUE(adjust(camera, found, 30));
  Eigen::Matrix3Xd from(3, 60);
  Eigen::Matrix3Xd to(3, 60);
  for (int i = 0; i < 60; ++i) {
    from.col(i) = found.points[static_cast<std::size_t>(i)];
    to.col(i) = truth.points[static_cast<std::size_t>(i)];
  }
  const geometry::Similarity truth_from_found = geometry::align_umeyama(from, to);
  EXPECT_NEAR(truth_from_found.scale, 1.0, 0.05);
  EXPECT_LT(rms_distance(moved(found, truth_from_found), truth), 0.05 * rms_distance(start, truth));
}

// The measurements are exact, so what is left of the perturbation is the stopping rule's.
TEST_F(BundleNumerics, NinetyFivePercentOfAPerturbationAreRecovered) {
  const geometry::Camera camera;
  const BundleProblem truth = bundle_scene(camera, 5, 60, 0.0);
  for (const double sigma : {1e-4, 1e-3, 1e-2, 0.03}) {
    const BundleProblem start = perturbed(truth, sigma);
    BundleProblem found = start;
    ASSERT_TRUE(adjust(camera, found, 30));
    EXPECT_LT(rms_distance(found, truth), 0.05 * rms_distance(start, truth)) << sigma;
    EXPECT_LT(rms_distance_of_views(found, truth), 0.05 * rms_distance_of_views(start, truth))
        << sigma;
  }
}

// Monocular scale is arbitrary, so it must not matter: 1e-6 of the world's size.
TEST_F(BundleNumerics, ScaleOfTheWorldDoesNotChangeTheResult) {
  const geometry::Camera camera;
  const BundleProblem start = perturbed(bundle_scene(camera, 5, 60, 0.3), 0.02);
  BundleProblem reference = start;
  ASSERT_TRUE(adjust(camera, reference, 10));
  for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    const geometry::Similarity larger{scale, geometry::Pose()};
    BundleProblem found = moved(start, larger);
    ASSERT_TRUE(adjust(camera, found, 10));
    const BundleProblem back = moved(found, larger.inverse());
    EXPECT_LT(rms_distance(back, reference), 1e-6) << scale;
    EXPECT_LT(rms_distance_of_views(back, reference), 1e-6) << scale;
  }
}

// One sighting leaves the depth open: the point keeps its distance and lies on its ray.
TEST_F(BundleNumerics, APointSeenOnceKeepsItsDistance) {
  const geometry::Camera camera;
  BundleProblem problem = bundle_scene(camera, 5, 60, 0.3);
  problem.points.emplace_back(0.7, 0.3, 4.0);
  problem.observations.push_back({3, 60, Eigen::Vector2d(300.0, 200.0), 1.0, {}, 0.0});
  const double before = (problem.views[3].camera_from_world * problem.points[60]).norm();
  ASSERT_TRUE(adjust(camera, problem, 30));
  const double after = (problem.views[3].camera_from_world * problem.points[60]).norm();
  EXPECT_NEAR(after, before, 0.1 * before);  // it moves across the ray by a tenth of that
  EXPECT_LT(problem.observations.back().error_in_sigma, 0.01);
}

// Three points determine a view up to four poses, without redundancy: it stays near its start
// (0.02 off), and the others do not notice.
TEST_F(BundleNumerics, AKeyframeWithThreePointsIsHarmless) {
  const geometry::Camera camera;
  const BundleProblem truth = bundle_scene(camera, 5, 60, 0.0);
  BundleProblem problem = perturbed(truth, 0.02);
  std::erase_if(problem.observations, [](const auto& o) { return o.view == 4 && o.point >= 3; });
  ASSERT_TRUE(adjust(camera, problem, 30));
  EXPECT_LT(rms_distance(problem, truth), 1e-3);
  EXPECT_LT(rms_distance_of_views(problem, truth), 1e-2);
}

// No parallax at all: rotation is found, to half a pixel (1e-3 rad), for the points, as free as the
// views, take up a part; translation, whatever it is, stays as invisible: 1e-3 of the distance.
TEST_F(BundleNumerics, AllPointsAtInfinityLeaveTheRotation) {
  for (const double distance : {1e6, 1e9, 1e12}) {
    const geometry::Camera camera;
    BundleProblem truth = bundle_scene(camera, 4, 40, 0.0);
    for (Vector3d& point : truth.points) point *= distance;
    for (auto& o : truth.observations) {
      const auto pixel =
          camera.project(truth.views[static_cast<std::size_t>(o.view)].camera_from_world *
                         truth.points[static_cast<std::size_t>(o.point)]);
      ASSERT_TRUE(pixel);
      o.pixel = *pixel;
    }
    BundleProblem problem = truth;
    for (std::size_t v = 2; v < 4; ++v) {
      auto& pose = problem.views[v].camera_from_world;
      pose.rotation = geometry::exp_so3({0.01, -0.02, 0.01}) * pose.rotation;
    }
    ASSERT_TRUE(adjust(camera, problem, 30)) << distance;
    EXPECT_TRUE(is_finite(problem)) << distance;
    for (std::size_t v = 2; v < 4; ++v) {
      const auto& found = problem.views[v].camera_from_world;
      const auto& wanted = truth.views[v].camera_from_world;
      EXPECT_LT(found.rotation.angularDistance(wanted.rotation), 1e-3) << distance;
      EXPECT_LT((found.inverse().translation - wanted.inverse().translation).norm(),
                1e-3 * distance)
          << distance;
    }
  }
}

// Points 4 to 400 away, where the cameras are 1.2 apart, whose depths start up to nine times too
// small or too large. Six steps must leave no more than a tenth above the cost that a hundred steps
// from the truth do: 4.02 of 4.02 are left. Adjusting positions instead leaves 85 000.
TEST_F(BundleNumerics, LowParallaxConvergesFromWrongDepths) {
  const geometry::Camera camera;
  BundleProblem truth = bundle_scene(camera, 5, 60, 0.0);
  for (std::size_t i = 0; i < truth.points.size(); ++i) {
    truth.points[i] *= std::pow(10.0, static_cast<double>(i) / 30.0);  // 4 to 400 away
  }
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.1);
  for (auto& o : truth.observations) {
    const auto pixel =
        camera.project(truth.views[static_cast<std::size_t>(o.view)].camera_from_world *
                       truth.points[static_cast<std::size_t>(o.point)]);
    ASSERT_TRUE(pixel);
    o.pixel = *pixel + Eigen::Vector2d(noise(random), noise(random));
  }
  const auto cost = [&](const BundleProblem& p) { return residuals(camera, p).squaredNorm(); };
  BundleProblem best = truth;
  ASSERT_TRUE(adjust(camera, best, 100));
  for (const double factor : {1.0 / 3.0, 3.0}) {
    BundleProblem problem = truth;
    std::uniform_real_distribution<double> wrong(-1.0, 1.0);
    for (auto& point : problem.points) point *= factor * std::pow(3.0, wrong(random));
    ASSERT_TRUE(adjust(camera, problem, 6));
    EXPECT_LT(cost(problem), 1.1 * cost(best)) << factor;
  }
}

// An observation of infinite sigma says nothing, even where it is the only one of a point.
TEST_F(BundleNumerics, AZeroWeightObservationSaysNothing) {
  const geometry::Camera camera;
  const BundleProblem truth = bundle_scene(camera, 5, 60, 0.0);
  BundleProblem problem = perturbed(truth, 0.02);
  problem.observations[7].sigma_px = std::numeric_limits<double>::infinity();
  problem.observations[7].pixel += Eigen::Vector2d(200.0, -100.0);
  problem.points.emplace_back(0.7, 0.3, 4.0);
  problem.observations.push_back(
      {3, 60, Eigen::Vector2d(300.0, 200.0), std::numeric_limits<double>::infinity(), {}, 0.0});
  ASSERT_TRUE(adjust(camera, problem, 30));
  EXPECT_LT((problem.points[60] - Vector3d(0.7, 0.3, 4.0)).norm(), 1e-15);
  EXPECT_EQ(problem.observations[7].error_in_sigma, 0.0);
  problem.points.pop_back();
  EXPECT_LT(rms_distance(problem, truth), 1e-3);
}

// A point behind a camera that is said to see it has no residual there. That one observation is
// reported as an outlier; before, it kept the whole adjustment from starting.
TEST_F(BundleNumerics, APointBehindACameraDoesNotStopTheOthers) {
  const geometry::Camera camera;
  const BundleProblem truth = bundle_scene(camera, 5, 60, 0.0);
  BundleProblem problem = perturbed(truth, 0.02);
  problem.points.emplace_back(0.0, 0.0, -4.0);
  problem.observations.push_back({2, 60, Eigen::Vector2d(300.0, 200.0), 1.0, {}, 0.0});
  ASSERT_TRUE(adjust(camera, problem, 30));
  EXPECT_EQ(problem.observations.back().error_in_sigma, std::numeric_limits<double>::infinity());
  problem.points.pop_back();
  EXPECT_LT(rms_distance(problem, truth), 1e-3);
}

TEST_F(BundleNumerics, NothingToAdjustIsNotAFailure) {
  const geometry::Camera camera;
  BundleProblem empty;
  EXPECT_TRUE(adjust(camera, empty, 5));
  BundleProblem unseen;
  unseen.views.resize(2);
  unseen.points.emplace_back(0.0, 0.0, 1.0);
  EXPECT_TRUE(adjust(camera, unseen, 5));
  EXPECT_EQ(unseen.points[0], Vector3d(0.0, 0.0, 1.0));
}

}  // namespace
}  // namespace lumibox::tracking
