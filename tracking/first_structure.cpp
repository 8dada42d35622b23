#include "tracking/first_structure.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geometry/absolute_pose.h"
#include "geometry/essential.h"
#include "geometry/homography.h"
#include "geometry/multi_view.h"
#include "geometry/robust.h"
#include "geometry/triangulation.h"
#include "geometry/two_view.h"
#include "geometry/two_view_models.h"

namespace lumibox::tracking {
namespace {

constexpr int kIterations = 8;         // per round of the adjustment
constexpr double kSame = 0.1;          // radians between directions of motion that are one solution
constexpr double kClear = 4.0;         // standard deviations by which the best must beat the next
constexpr double kAgree = 0.2;         // radians between the directions of one motion found twice
constexpr double kOutlierSigmas = 4;   // of a point's error over all views
constexpr double kMaxBehind = 0.05;    // share of the points that may lie beyond infinity
constexpr double kMinDepthSigmas = 3;  // points surer than that have a depth

geometry::MultiView start_of(const geometry::Pose& last_from_first, const Bearings& bearings,
                             double noise_rad) {
  geometry::MultiView start;
  const std::size_t count = bearings.front().size();
  const Eigen::Matrix3d essential = geometry::essential_from_motion(last_from_first);
  const double bound = geometry::essential_bound() * noise_rad * noise_rad;
  std::vector<Eigen::Vector3d> points(count, Eigen::Vector3d::Zero());
  std::vector<bool> known(count, false);
  std::vector<double> inverse;
  for (std::size_t i = 0; i < count; ++i) {
    const geometry::BearingPair pair{bearings.front()[i], bearings.back()[i]};
    if (!(geometry::essential_error2(essential, pair) < bound)) continue;
    const auto point =
        geometry::triangulate(geometry::Pose(), last_from_first, pair.first, pair.second);
    if (!point) continue;
    points[i] = *point;
    known[i] = true;
    inverse.push_back(1.0 / point->norm());
  }
  const double typical = geometry::median(std::move(inverse));
  for (std::size_t i = 0; i < count; ++i) {
    start.inverse_distance.push_back(known[i] ? 1.0 / points[i].norm() : typical);
  }
  for (std::size_t v = 1; v < bearings.size(); ++v) {
    const double share = static_cast<double>(v) / static_cast<double>(bearings.size() - 1);
    const geometry::Pose between = geometry::exp_se3(share * geometry::log_se3(last_from_first));
    start.view_from_first.push_back(
        v + 1 < bearings.size()
            ? geometry::refine_absolute_pose(between, points, bearings[v], known)
            : last_from_first);
  }
  return start;
}

/// How much more clearly the points speak for `a` than for `b`, in standard deviations: the sum of
/// the differences of their squared errors over the root of the sum of those squares (Vuong,
/// "Likelihood ratio tests for model selection and non-nested hypotheses", 1989). A point counts
/// once however many views saw it, for the errors along a track are alike; an outlier counts as
/// much as the next.
double preference(const geometry::MultiView& a, const geometry::MultiView& b) {
  const double sigma = std::min(a.sigma_rad, b.sigma_rad);
  const double bound = 2.0 * kOutlierSigmas * kOutlierSigmas * sigma * sigma;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < a.squared_errors.size(); ++i) {
    const double difference =
        std::min(bound, b.squared_errors[i]) - std::min(bound, a.squared_errors[i]);
    sum += difference;
    squares += difference * difference;
  }
  return squares > 0.0 ? sum / std::sqrt(squares) : 0.0;
}

bool is_outlier(const geometry::MultiView& solution, std::size_t i) {
  const double bound = kOutlierSigmas * solution.sigma_rad;
  return solution.squared_errors[i] > 2.0 * bound * bound;
}

bool is_behind(const geometry::MultiView& solution, std::size_t i) {
  return solution.inverse_distance[i] < -2.0 * solution.inverse_distance_sigma[i];
}

const geometry::Pose& last_of(const geometry::MultiView& solution) {
  return solution.view_from_first.back();
}

/// Angle between the motions to the last view, whichever their length.
double apart(const geometry::Pose& a, const geometry::Pose& b) {
  return geometry::angle_between(a.translation, b.translation);
}

/// Motions between first and last view that move the plane nearest to the solution's points as the
/// solution does: its own and the dual one.
std::vector<geometry::Pose> duals_of(const geometry::MultiView& solution,
                                     const Bearings& bearings) {
  // On a plane n . x = d the inverse distance along a bearing b is (n / d) . b.
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < bearings.front().size(); ++i) {
    if (is_outlier(solution, i)) continue;
    const Eigen::Vector3d& b = bearings.front()[i];
    moments += b * b.transpose();
    sum += solution.inverse_distance[i] * b;
    middle += b;
  }
  const Eigen::Vector3d plane = moments.inverse() * sum;
  const geometry::Pose& last = last_of(solution);
  const Eigen::Matrix3d homography = last.matrix3() + last.translation * plane.transpose();
  if (!homography.allFinite()) return {};
  const double scale = Eigen::JacobiSVD<Eigen::Matrix3d>(homography).singularValues()[1];
  // The scene is no plane, so the plane need not be in front everywhere: the middle decides.
  const std::array<geometry::BearingPair, 1> ahead{
      geometry::BearingPair{middle.normalized(), Eigen::Vector3d::UnitZ()}};
  std::vector<geometry::Pose> motions;
  for (const auto& option : geometry::motions_of_homography(homography / scale, ahead)) {
    motions.push_back(option.second_from_first);
  }
  return motions;
}

/// Share of the points that lie behind the first camera, which no solution can be true with.
double share_behind(const geometry::MultiView& solution) {
  std::size_t behind = 0;
  for (std::size_t i = 0; i < solution.inverse_distance.size(); ++i) {
    if (!is_outlier(solution, i) && is_behind(solution, i)) ++behind;
  }
  return static_cast<double>(behind) / static_cast<double>(solution.inverse_distance.size());
}

/// Where the points are; none for outliers and for those that may be anywhere.
std::vector<std::optional<Eigen::Vector3d>> points_of(
    const geometry::MultiView& solution, const std::vector<Eigen::Vector3d>& first_bearings) {
  std::vector<std::optional<Eigen::Vector3d>> points(first_bearings.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double inverse = solution.inverse_distance[i];
    const bool sure = inverse > kMinDepthSigmas * solution.inverse_distance_sigma[i];
    if (sure && !is_outlier(solution, i)) points[i] = first_bearings[i] / inverse;
  }
  return points;
}

geometry::TwoViewResult race_first_against_last(const Bearings& bearings,
                                                const FirstStructureOptions& options) {
  std::vector<geometry::BearingPair> pairs;
  for (std::size_t i = 0; i < bearings.front().size(); ++i) {
    pairs.push_back({bearings.front()[i], bearings.back()[i]});
  }
  geometry::TwoViewOptions two_view;
  two_view.sigma_rad = options.noise_rad;
  two_view.min_inliers = options.min_points;
  two_view.min_parallax_rad = 0.0;  // how well the depths are known is judged over all views
  two_view.seed = options.seed;
  return geometry::solve_two_view(pairs, two_view);
}

/// What to say where two views allow no motion with a translation.
std::optional<TrackingReason> refusal_of(geometry::TwoViewOutcome outcome) {
  switch (outcome) {
    case geometry::TwoViewOutcome::Ok:
    case geometry::TwoViewOutcome::PlaneAmbiguous:
    case geometry::TwoViewOutcome::LowParallax:
      return std::nullopt;
    case geometry::TwoViewOutcome::TooFewPoints:
      return TrackingReason::TooLittleTexture;
    case geometry::TwoViewOutcome::RotationOnly:
      return TrackingReason::TurningOnly;
    case geometry::TwoViewOutcome::NotEnoughInliers:
    case geometry::TwoViewOutcome::NoMotion:
      return TrackingReason::MoveSideways;
  }
  return TrackingReason::MoveSideways;
}

/// Solutions that can be true, and what speaks against each.
class Contest {
 public:
  Contest(const Bearings& bearings, double noise_rad)
      : bearings_(bearings), noise_rad_(noise_rad) {}

  /// Adjusts from a motion between the first and the last view, and from the dual of what that
  /// gives. Where no barrier keeps the dual from sliding back, it is held for the comparison.
  void enter(const geometry::Pose& last_from_first) {
    const geometry::MultiView solution = adjusted(last_from_first);
    for (const geometry::Pose& dual : duals_of(solution, bearings_)) {
      if (apart(dual, last_of(solution)) < kSame) continue;
      const geometry::MultiView other = adjusted(dual);
      add(apart(last_of(other), last_of(solution)) < kSame
              ? adjusted(dual, geometry::MotionFreedom::LastDirectionHeld)
              : other);
    }
    add(solution);
  }

  bool empty() const { return solutions_.empty(); }

  const geometry::MultiView& best() const {
    return *std::ranges::max_element(
        solutions_, [](const auto& a, const auto& b) { return preference(b, a) > 0.0; });
  }

  /// Whether the best is better than every other motion by more than chance.
  bool decided() const {
    const geometry::MultiView& winner = best();
    return std::ranges::all_of(solutions_, [&](const auto& other) {
      return apart(last_of(other), last_of(winner)) < kSame || preference(winner, other) > kClear;
    });
  }

 private:
  geometry::MultiView adjusted(
      const geometry::Pose& last_from_first,
      geometry::MotionFreedom freedom = geometry::MotionFreedom::All) const {
    return geometry::adjust_multi_view(bearings_, start_of(last_from_first, bearings_, noise_rad_),
                                       kIterations, freedom);
  }

  void add(const geometry::MultiView& solution) {
    if (share_behind(solution) <= kMaxBehind) solutions_.push_back(solution);
  }

  const Bearings& bearings_;
  double noise_rad_;
  std::vector<geometry::MultiView> solutions_;
};

}  // namespace

bool agrees(const geometry::Pose& earlier, const geometry::Pose& later) {
  return apart(earlier, later) < kAgree;
}

FirstStructure find_first_structure(const Bearings& bearings,
                                    const FirstStructureOptions& options) {
  FirstStructure result;
  const geometry::TwoViewResult race = race_first_against_last(bearings, options);
  if (const auto refusal = refusal_of(race.outcome)) {
    result.reason = *refusal;
    return result;
  }
  Contest contest(bearings, options.noise_rad);
  for (const geometry::Pose& motion : race.candidates) contest.enter(motion);
  if (contest.empty()) return result;
  const geometry::MultiView& best = contest.best();
  result.view_from_first = best.view_from_first;
  result.points = points_of(best, bearings.front());
  const auto used =
      std::ranges::count_if(result.points, [](const auto& p) { return p.has_value(); });
  if (used < options.min_points ||
      !(geometry::relative_depth_sigma(best) < options.max_depth_sigma))
    return result;
  result.reason = contest.decided() ? TrackingReason::None : TrackingReason::PlaneAmbiguous;
  return result;
}

}  // namespace lumibox::tracking
