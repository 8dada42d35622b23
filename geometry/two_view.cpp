#include "geometry/two_view.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/essential.h"
#include "geometry/homography.h"
#include "geometry/motion_refinement.h"
#include "geometry/robust.h"
#include "geometry/triangulation.h"
#include "geometry/two_view_models.h"

namespace lumibox::geometry {
namespace {

/// Fraction of all pairs that a motion must explain; with fewer, chance agreement of wrong matches
/// with an epipolar line (about 1 % of them each) is no longer negligible.
constexpr double kMinInlierFraction = 0.2;

/// Another motion remains possible if it explains all but this fraction of the inliers as well.
constexpr double kClearMargin = 0.1;

/// Motions nearer than this to each other are the same solution found twice.
constexpr double kSameRotation = 0.02;
constexpr double kSameDirection = 0.1;

constexpr int kRefineIterations = 20;

/// A motion with all that it says about the pairs.
struct Candidate {
  Pose motion;
  double cost = 0.0;  ///< squared errors in variances, each clipped at the bound of an inlier
  std::vector<bool> inliers;
  int inlier_count = 0;
  std::vector<std::optional<Eigen::Vector3d>> points;
  double median_parallax_rad = 0.0;
};

Candidate assess(const Pose& motion, std::span<const BearingPair> pairs, double sigma_rad) {
  const double inverse_variance = 1.0 / (sigma_rad * sigma_rad);
  const double bound = essential_bound();
  const Eigen::Matrix3d essential = essential_from_motion(motion);
  Candidate candidate;
  candidate.motion = motion;
  candidate.inliers.assign(pairs.size(), false);
  candidate.points.assign(pairs.size(), std::nullopt);
  std::vector<double> parallaxes;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double error2 = essential_error2(essential, pairs[i]) * inverse_variance;
    candidate.cost += bound;
    if (!(error2 < bound)) continue;
    // Points so far away that noise puts them behind the cameras count here, or a motion without
    // measurable parallax would be taken for one without inliers.
    parallaxes.push_back(angle_between(motion.rotation * pairs[i].first, pairs[i].second));
    candidate.points[i] = triangulate(Pose(), motion, pairs[i].first, pairs[i].second);
    if (!candidate.points[i]) continue;
    candidate.inliers[i] = true;
    ++candidate.inlier_count;
    candidate.cost += error2 - bound;
  }
  candidate.median_parallax_rad = median(std::move(parallaxes));
  return candidate;
}

/// Of the four motions of an essential matrix, the one with most points in front of both cameras.
Candidate best_of_essential(const Eigen::Matrix3d& essential, std::span<const BearingPair> pairs,
                            double sigma_rad) {
  std::vector<Candidate> four;
  for (const Pose& motion : motions_of_essential(essential)) {
    four.push_back(assess(motion, pairs, sigma_rad));
  }
  return *std::ranges::min_element(four, {}, &Candidate::cost);
}

bool is_same(const Pose& a, const Pose& b) {
  return a.rotation.angularDistance(b.rotation) < kSameRotation &&
         angle_between(a.translation, b.translation) < kSameDirection;
}

/// All motions worth a look, best first. A homography that explains nearly as much as the essential
/// matrix brings its own two, for a scene of few points off a plane can support a wrong motion.
std::vector<Candidate> list_candidates(const ModelFit& plane, const ModelFit& general, bool planar,
                                       std::span<const BearingPair> pairs, double sigma_rad) {
  std::vector<Candidate> found;
  if (!planar) found.push_back(best_of_essential(general.model, pairs, sigma_rad));
  std::vector<BearingPair> on_plane;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (plane.inliers[i]) on_plane.push_back(pairs[i]);
  }
  for (const PlaneMotion& option : motions_of_homography(plane.model, on_plane)) {
    const Pose refined =
        refine_motion(option.second_from_first, pairs, plane.inliers, kRefineIterations);
    Candidate candidate = assess(refined, pairs, sigma_rad);
    if (planar) {
      // Freed of the plane, the motion shows whether the pairs off the plane agree with it. As an
      // estimate, the motion under the plane's constraint is the more accurate one.
      const double cost = candidate.cost;
      candidate = assess(option.second_from_first, pairs, sigma_rad);
      candidate.cost = cost;
    }
    found.push_back(std::move(candidate));
  }
  std::ranges::stable_sort(found, {}, &Candidate::cost);

  std::vector<Candidate> distinct;
  for (Candidate& candidate : found) {
    const bool repeated = std::ranges::any_of(
        distinct, [&](const Candidate& other) { return is_same(other.motion, candidate.motion); });
    if (!repeated) distinct.push_back(std::move(candidate));
  }
  return distinct;
}

/// Drops the candidates that cost clearly more than the first.
void keep_contenders(std::vector<Candidate>* candidates) {
  const double bound = essential_bound();
  const double limit = candidates->front().cost +
                       bound * kClearMargin * static_cast<double>(candidates->front().inlier_count);
  std::erase_if(*candidates, [limit](const Candidate& c) { return c.cost > limit; });
}

/// Whether the flagged first bearings lie, to within noise, in one plane through the centre, as
/// points on a line (or fewer than three points) do: they leave every model undetermined.
bool on_one_line(std::span<const BearingPair> pairs, const std::vector<bool>& flags,
                 double sigma_rad) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!flags[i]) continue;
    moments += pairs[i].first * pairs[i].first.transpose();
    count += 1.0;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(moments, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()[0] < 9.0 * sigma_rad * sigma_rad * count;
}

void adopt(Candidate&& winner, TwoViewResult* result) {
  result->second_from_first = winner.motion;
  result->inliers = std::move(winner.inliers);
  result->inlier_count = winner.inlier_count;
  result->points = std::move(winner.points);
  result->median_parallax_rad = winner.median_parallax_rad;
}

}  // namespace

TwoViewResult solve_two_view(std::span<const BearingPair> pairs, const TwoViewOptions& options) {
  TwoViewResult result;
  result.inliers.assign(pairs.size(), false);
  result.points.assign(pairs.size(), std::nullopt);
  if (pairs.size() < 5 || static_cast<int>(pairs.size()) < options.min_inliers) return result;
  const int required =
      std::max(options.min_inliers,
               static_cast<int>(std::ceil(kMinInlierFraction * static_cast<double>(pairs.size()))));

  const RansacOptions ransac{options.sigma_rad, options.max_iterations, options.seed};
  const ModelFit still = assess_no_motion(pairs, options.sigma_rad);
  const ModelFit rotation = find_rotation(pairs, ransac);
  // Samples of four need fewer draws than samples of five, and where most pairs are not on one
  // plane no number of draws would do.
  const RansacOptions plane_ransac{options.sigma_rad, options.max_iterations / 3, options.seed};
  const ModelFit plane = find_homography(pairs, plane_ransac);
  const ModelFit general = find_essential(pairs, ransac);

  const bool is_still = still.criterion <= rotation.criterion;
  const ModelFit& turned = is_still ? still : rotation;
  const ModelFit& moved = plane.criterion < general.criterion ? plane : general;
  const ModelFit& winner = turned.criterion <= moved.criterion ? turned : moved;
  result.planar = &winner == &plane;
  if (winner.inlier_count < required || on_one_line(pairs, winner.inliers, options.sigma_rad)) {
    result.outcome = TwoViewOutcome::NotEnoughInliers;
    return result;
  }
  if (&winner == &turned) {
    result.outcome = is_still ? TwoViewOutcome::NoMotion : TwoViewOutcome::RotationOnly;
    result.second_from_first = Pose(turned.model, Eigen::Vector3d::Zero());
    result.inliers = turned.inliers;
    result.inlier_count = turned.inlier_count;
    return result;
  }

  std::vector<Candidate> candidates =
      list_candidates(plane, general, result.planar, pairs, options.sigma_rad);
  if (candidates.empty()) {  // a homography that is a rotation to within its rounding
    result.outcome = TwoViewOutcome::LowParallax;
    result.second_from_first = Pose(rotation.model, Eigen::Vector3d::Zero());
    return result;
  }
  keep_contenders(&candidates);
  for (const Candidate& candidate : candidates) result.candidates.push_back(candidate.motion);
  adopt(std::move(candidates.front()), &result);
  if (result.median_parallax_rad < options.min_parallax_rad) {
    result.outcome = TwoViewOutcome::LowParallax;
  } else if (result.inlier_count < required) {
    result.outcome = TwoViewOutcome::NotEnoughInliers;
  } else {
    result.outcome =
        result.candidates.size() > 1 ? TwoViewOutcome::PlaneAmbiguous : TwoViewOutcome::Ok;
  }
  return result;
}

}  // namespace lumibox::geometry
