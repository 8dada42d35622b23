#include "geometry/multi_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "geometry/multi_view_scene.h"
#include "geometry/robust.h"

namespace lumibox::geometry {
namespace {

constexpr double kSigma = 3e-4;  // a sixth of a pixel at f = 540
constexpr int kViews = 5;

/// A start as two views and their points would give it, a few degrees and tenths off.
MultiView roughly(const MultiViewScene& scene) {
  MultiView start;
  for (const Pose& pose : scene.views) {
    start.view_from_first.emplace_back(
        exp_so3({0.002, -0.003, 0.002}) * pose.rotation,
        pose.translation + 0.1 * pose.translation.norm() * Eigen::Vector3d(0.3, 1.0, -0.5));
  }
  for (const Eigen::Vector3d& point : scene.points) {
    start.inverse_distance.push_back(1.2 / point.norm());
  }
  return start;
}

/// What inverse distances are multiplied by to have the truth's scale.
double scale_of(const MultiView& found, const MultiViewScene& scene) {
  double along = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    along += found.inverse_distance[i] / scene.points[i].norm();
    squares += found.inverse_distance[i] * found.inverse_distance[i];
  }
  return along / squares;
}

TEST(MultiView, ExactTracksGiveTheExactWorld) {
  const MultiViewScene scene = sideways_scene(3, 80, kViews);
  const MultiView found = adjust_multi_view(scene.look(0.0, 1), roughly(scene), 20);
  const double scale = scale_of(found, scene);
  // 1e-6: the adjustment stops when a step gains less than 1e-4 of a cost that goes to zero.
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    EXPECT_NEAR(scale * found.inverse_distance[i] * scene.points[i].norm(), 1.0, 1e-6) << i;
  }
  EXPECT_LT(angle_between(found.view_from_first.back().translation, scene.views.back().translation),
            1e-6);
  EXPECT_NEAR(found.view_from_first.back().translation.norm(), 1.0, 1e-12);
}

// Errors in units of the standard deviation that is claimed for them have the variance 1: over 20
// worlds of 24 points to 0.3, the spread of such a mean of squares that share their cameras.
// Without the cameras' own uncertainty it is 2.3 here.
TEST(MultiView, ErrorsAreAsLargeAsTheStandardDeviationSays) {
  double squares = 0.0;
  double count = 0.0;
  double noise = 0.0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const MultiViewScene scene = sideways_scene(seed, 24, kViews);
    const MultiView found = adjust_multi_view(scene.look(kSigma, seed), roughly(scene), 20);
    const double scale = scale_of(found, scene);
    noise += found.sigma_rad / 20.0;
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
      const double error = found.inverse_distance[i] - 1.0 / (scale * scene.points[i].norm());
      squares += std::pow(error / found.inverse_distance_sigma[i], 2);
      count += 1.0;
    }
  }
  EXPECT_NEAR(noise, kSigma, 0.1 * kSigma);
  EXPECT_NEAR(squares / count, 1.0, 0.3);
}

TEST(MultiView, ATenthOfWrongTracksHardlyMatters) {
  const MultiViewScene scene = sideways_scene(5, 100, kViews);
  auto bearings = scene.look(kSigma, 5);
  for (std::size_t i = 0; i < 10; ++i) {
    for (std::size_t v = 1; v <= kViews; ++v) {
      bearings[v][i] =
          (bearings[v][i] + Eigen::Vector3d(0.0, 0.01 * static_cast<double>(v), 0.0)).normalized();
    }
  }
  const MultiView found = adjust_multi_view(bearings, roughly(scene), 20);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_GT(found.squared_errors[i], 100.0 * kSigma * kSigma);
  EXPECT_LT(angle_between(found.view_from_first.back().translation, scene.views.back().translation),
            0.05);
  EXPECT_NEAR(found.sigma_rad, kSigma, 0.2 * kSigma);
}

TEST(MultiView, MirroredThroughTheFirstCameraIsTheSameSolution) {
  const MultiViewScene scene = sideways_scene(6, 60, kViews);
  MultiView mirrored = roughly(scene);
  for (Pose& pose : mirrored.view_from_first) pose.translation = -pose.translation;
  for (double& inverse : mirrored.inverse_distance) inverse = -inverse;
  const MultiView found = adjust_multi_view(scene.look(kSigma, 6), mirrored, 20);
  for (const double inverse : found.inverse_distance) EXPECT_GT(inverse, 0.0);
}

TEST(MultiView, ADirectionThatIsHeldStays) {
  const MultiViewScene scene = sideways_scene(9, 60, kViews);
  const MultiView start = roughly(scene);
  const auto turned = [&](MotionFreedom freedom) {
    const MultiView found = adjust_multi_view(scene.look(kSigma, 9), start, 20, freedom);
    return angle_between(found.view_from_first.back().translation,
                         start.view_from_first.back().translation);
  };
  EXPECT_LT(turned(MotionFreedom::LastDirectionHeld), 1e-3);
  EXPECT_GT(turned(MotionFreedom::All), 0.05);
}

// A turn has no parallax: whatever translation fits the noise, no depth is known.
TEST(MultiView, ATurnLeavesDepthsUnknown) {
  MultiViewScene scene = sideways_scene(7, 120, kViews);
  MultiView start = roughly(scene);
  for (Pose& pose : scene.views) pose.translation.setZero();
  start.inverse_distance.assign(scene.points.size(), 0.2);
  EXPECT_GT(relative_depth_sigma(adjust_multi_view(scene.look(kSigma, 7), start, 20)), 0.3);
}

TEST(MultiView, MoreParallaxMakesDepthsSurer) {
  const auto sigma = [](double step) {
    MultiViewScene scene = sideways_scene(8, 100, kViews);
    for (Pose& pose : scene.views) pose.translation *= step;
    return relative_depth_sigma(adjust_multi_view(scene.look(kSigma, 8), roughly(scene), 20));
  };
  // Twice the way, half the error; noise of the estimate itself aside.
  EXPECT_NEAR(sigma(1.0) / sigma(2.0), 2.0, 0.4);
}

}  // namespace
}  // namespace lumibox::geometry
