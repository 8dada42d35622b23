#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>

#include "geometry/absolute_pose.h"
#include "geometry/homography.h"
#include "geometry/triangulation.h"
#include "geometry/two_view.h"
#include "geometry/two_view_scene.h"
#include "numerics/bundle_scene.h"

namespace lumibox::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kSigma = 0.5 / 600.0;

Similarity any_similarity(TwoViewScene* scene) {
  return {std::exp(scene->uniform(-3.0, 3.0)),
          {exp_so3(scene->uniform(0.0, 3.1) * scene->direction()),
           scene->uniform(0.0, 10.0) * scene->direction()}};
}

template <typename T>
std::vector<T> shuffled(std::vector<T> all, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::shuffle(all.begin(), all.end(), random);
  return all;
}

// Scales up to 20, coordinates up to 10: products of three reach 1e5, so 1e-10 is ten roundings.
RC_GTEST_PROP(InvarianceNumerics, SimilaritiesFormAGroup, (std::uint32_t seed)) {
  TwoViewScene scene(seed);
  const Similarity a = any_similarity(&scene);
  const Similarity b = any_similarity(&scene);
  const Similarity c = any_similarity(&scene);
  const Vector3d x = scene.direction();
  RC_ASSERT((((a * b) * c) * x - a * (b * (c * x))).norm() < 1e-10);
  RC_ASSERT(((a.inverse() * a) * x - x).norm() < 1e-12);
  RC_ASSERT(((a * b).inverse() * x - b.inverse() * (a.inverse() * x)).norm() < 1e-9);
  RC_ASSERT((a * Similarity() * x - a * x).norm() < 1e-12);
  // exp of -twist is the inverse, and of half a twist the root.
  const Vector7d twist = log_sim3(a);
  RC_ASSERT((exp_sim3(-twist) * (a * x) - x).norm() < 1e-11);
  const Similarity half = exp_sim3(0.5 * twist);
  RC_ASSERT((half * (half * x) - a * x).norm() < 1e-11);
}

// The point moves with the world. Depth is known to rounding over the parallax (about 0.1), times
// the size of the moved world, up to 1e3.
RC_GTEST_PROP(InvarianceNumerics, TriangulationMovesWithTheWorld, (std::uint32_t seed)) {
  TwoViewScene scene(seed);
  const Similarity s = any_similarity(&scene);
  const Pose first(exp_so3(0.2 * scene.direction()), 0.3 * scene.direction());
  const Pose second(exp_so3(0.2 * scene.direction()), 0.3 * scene.direction());
  const Vector3d point = scene.volume(1, 2.0, 6.0)[0];
  const Vector3d a = scene.look(first * point, kSigma);
  const Vector3d b = scene.look(second * point, kSigma);
  if (parallax_angle(first, second, point) < 0.02) return;
  const auto found = triangulate(first, second, a, b);
  const auto in_moved =
      triangulate((s * first.inverse()).inverse(), (s * second.inverse()).inverse(), a, b);
  const auto swapped = triangulate(second, first, b, a);
  RC_ASSERT(found.has_value() && in_moved.has_value() && swapped.has_value());
  RC_ASSERT((*in_moved - s * *found).norm() < 1e-9 * s.scale * found->norm() + 1e-12);
  RC_ASSERT((*swapped - *found).norm() < 1e-11);
}

// A homography made of a plane and a motion has two decompositions; each must make the same
// homography again, and one must be the true one. 1e-7: the decomposition takes square roots of
// differences from 1, which halves the digits where the baseline is small.
RC_GTEST_PROP(InvarianceNumerics, BothDecompositionsMakeTheHomography, (std::uint32_t seed)) {
  TwoViewScene scene(seed);
  const Vector3d normal =
      Vector3d(scene.uniform(-0.5, 0.5), scene.uniform(-0.5, 0.5), -1.0).normalized();
  const Pose motion(exp_so3(0.3 * scene.direction()), scene.uniform(0.01, 0.5) * scene.direction());
  const auto pairs = scene.observe(scene.on_plane(30, normal, -2.0), motion, 0.0);
  const auto h = fit_homography(pairs);
  RC_ASSERT(h.has_value());
  const auto motions = motions_of_homography(*h, pairs);
  RC_ASSERT(!motions.empty());
  double nearest = 4.0;
  for (const PlaneMotion& m : motions) {
    // H - R = (length of t / distance) t n^T, rank one.
    const Eigen::Matrix3d rest = *h - m.second_from_first.matrix3();
    const Eigen::Matrix3d outer = m.second_from_first.translation * m.normal.transpose();
    RC_ASSERT((rest - rest.cwiseProduct(outer).sum() * outer).norm() < 1e-7);
    nearest = std::min(nearest, angle_between(m.second_from_first.translation, motion.translation) +
                                    angle_between(m.normal, -normal));
  }
  RC_ASSERT(nearest < 1e-6);
}

// Time mirrored: with the views swapped the motion is the inverse one. Other samples are drawn, the
// optimum is the same: a fifth of its own uncertainty of about 0.02.
RC_GTEST_PROP(InvarianceNumerics, SwappedViewsGiveTheInverseMotion, ()) {
  const auto seed = static_cast<std::uint32_t>(*rc::gen::inRange(1, 1000));
  TwoViewScene scene(seed);
  const Pose motion(exp_so3(0.1 * scene.direction()), {0.6, scene.uniform(-0.2, 0.2), 0.1});
  auto pairs = scene.observe(scene.volume(120, 2.0, 6.0), motion, 0.2 * kSigma);
  const auto forwards = solve_two_view(pairs, {.sigma_rad = kSigma});
  for (BearingPair& pair : pairs) std::swap(pair.first, pair.second);
  const auto backwards = solve_two_view(shuffled(pairs, seed), {.sigma_rad = kSigma});
  RC_ASSERT(forwards.outcome == TwoViewOutcome::Ok);
  RC_ASSERT(backwards.outcome == TwoViewOutcome::Ok);
  const Pose inverse = backwards.second_from_first.inverse();
  RC_ASSERT(forwards.second_from_first.rotation.angularDistance(inverse.rotation) < 0.004);
  RC_ASSERT(angle_between(forwards.second_from_first.translation, inverse.translation) < 0.02);
}

struct PnpScene {
  std::vector<Vector3d> points;
  std::vector<Vector3d> bearings;
  Pose camera_from_world;
};

PnpScene pnp_scene(std::uint32_t seed, int count) {
  TwoViewScene scene(seed);
  PnpScene pnp{{}, {}, Pose(exp_so3(scene.direction()), scene.direction())};
  for (const Vector3d& p : scene.volume(count, 2.0, 6.0)) {
    pnp.bearings.push_back(scene.look(p, 0.2 * kSigma));
    pnp.points.push_back(pnp.camera_from_world.inverse() * p);
  }
  return pnp;
}

// The optimum does not depend on the order of the points, nor on the world they live in, a million
// times larger or smaller included: 1e-6 of the world, where the refinement stops.
RC_GTEST_PROP(InvarianceNumerics, AbsolutePoseMovesWithTheWorldAndIgnoresOrder, ()) {
  const auto seed = static_cast<std::uint32_t>(*rc::gen::inRange(1, 1000));
  const PnpScene pnp = pnp_scene(seed, 40);
  const auto found = solve_absolute_pose(pnp.points, pnp.bearings, 4.0 * kSigma, 1);
  RC_ASSERT(found.has_value());
  const Pose center = found->camera_from_world.inverse();

  const auto reordered = solve_absolute_pose(shuffled(pnp.points, seed),
                                             shuffled(pnp.bearings, seed), 4.0 * kSigma, 1);
  RC_ASSERT(reordered.has_value());
  RC_ASSERT((reordered->camera_from_world.inverse().translation - center.translation).norm() <
            1e-6);

  TwoViewScene scene(seed);
  for (const double scale : {1e-9, 1e-6, 1.0, 1e6, 1e9}) {
    const Similarity s{scale, {exp_so3(scene.direction()), scale * scene.direction()}};
    std::vector<Vector3d> moved = pnp.points;
    for (Vector3d& point : moved) point = s * point;
    const auto in_moved = solve_absolute_pose(moved, pnp.bearings, 4.0 * kSigma, 1);
    RC_ASSERT(in_moved.has_value());
    const Pose back = s.inverse() * in_moved->camera_from_world.inverse();
    RC_ASSERT((back.translation - center.translation).norm() < 1e-6);
  }
}

// From a start half a degree and 0.03 off, the refinement alone: it must work in a world of any
// size, for its damping is relative.
TEST(InvarianceNumerics, RefinementWorksInAWorldOfAnySize) {
  const PnpScene pnp = pnp_scene(7, 40);
  const std::vector<bool> all(40, true);
  for (const double scale : {1e-9, 1e-6, 1.0, 1e6, 1e9, 1e12}) {
    std::vector<Vector3d> points = pnp.points;
    for (Vector3d& point : points) point *= scale;
    Pose start(exp_so3({0.01, -0.01, 0.01}) * pnp.camera_from_world.rotation,
               scale * (pnp.camera_from_world.translation + Vector3d(0.03, 0.0, -0.03)));
    const Pose found = refine_absolute_pose(start, points, pnp.bearings, all);
    EXPECT_LT((found.translation / scale - pnp.camera_from_world.translation).norm(), 2e-3)
        << scale;
    EXPECT_LT(found.rotation.angularDistance(pnp.camera_from_world.rotation), 1e-3) << scale;
  }
}

// Far away, depth is what the rays hardly show: with exact bearings (1e-16), points of size 1 and
// distance d it is known to 1e-16 d^2 of itself. Rotation keeps its 1e-12.
TEST(InvarianceNumerics, AbsolutePoseFarAway) {
  for (const double distance : {10.0, 1e2, 1e3, 1e4}) {
    TwoViewScene scene(4);
    const Pose truth(exp_so3(scene.direction()), Vector3d(0.0, 0.0, distance));
    std::vector<Vector3d> points;
    std::vector<Vector3d> bearings;
    for (int i = 0; i < 40; ++i) {
      points.push_back(scene.direction());
      bearings.push_back((truth * points.back()).normalized());
    }
    const auto found = solve_absolute_pose(points, bearings, 0.02 / distance, 1);
    ASSERT_TRUE(found) << distance;
    EXPECT_EQ(found->inlier_count, 40);
    EXPECT_LT(found->camera_from_world.rotation.angularDistance(truth.rotation), 1e-5) << distance;
    EXPECT_LT((found->camera_from_world.translation - truth.translation).norm() / distance,
              1e-6 + 1e-13 * distance * distance)
        << distance;
  }
}

}  // namespace
}  // namespace lumibox::geometry

namespace lumibox::tracking {
namespace {

// Bundle adjustment in a world moved by any similarity, and with the sightings in another order,
// ends at the same place. Its damping knows the world's axes, so other steps lead there, and it
// stops when one gains less than 1e-5 of the cost: 5e-4 of a world of size 5, where 1.2e-4 was
// seen.
RC_GTEST_PROP(InvarianceNumerics, BundleAdjustmentMovesWithTheWorldAndIgnoresOrder, ()) {
  const auto seed = static_cast<std::uint32_t>(*rc::gen::inRange(1, 1000));
  const geometry::Camera camera;
  const BundleProblem start = perturbed(bundle_scene(camera, 4, 25, 0.3), 0.01);
  BundleProblem reference = start;
  RC_ASSERT(adjust(camera, reference, 10));
  geometry::TwoViewScene random(seed);
  const geometry::Similarity s{std::exp(random.uniform(-5.0, 5.0)),
                               {geometry::exp_so3(3.0 * random.direction()), random.direction()}};
  BundleProblem found = moved(start, s);
  std::mt19937 order(seed);
  std::shuffle(found.observations.begin(), found.observations.end(), order);
  RC_ASSERT(adjust(camera, found, 10));
  const BundleProblem back = moved(found, s.inverse());
  RC_ASSERT(rms_distance_of_views(back, reference) < 5e-4);
  RC_ASSERT(rms_distance(back, reference) < 1e-3);
}

}  // namespace
}  // namespace lumibox::tracking
