#include "lightfield/track_triangulation.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/levenberg_marquardt.h"
#include "geometry/triangulation.h"

namespace lumibox::lightfield {
namespace {

constexpr std::size_t kMinViews = 3;
constexpr std::size_t kMaxPairs = 60;    // tried per track
constexpr double kMinParallax = 0.01;    // radians, of a pair that is tried
constexpr double kSigmaShare = 0.5;      // standard deviation of a pixel, in tolerances
constexpr double kMaxDepthSigma = 0.04;  // of the distance
constexpr int kIterations = 10;
constexpr int kRounds = 3;  // of choosing the observations and adjusting the point

/// A point relative to one camera: its normalised place there and 1 / depth, in some unit of length
/// of about the depth, so that the equations do not depend on the world's scale.
using InverseDepth = Eigen::Vector3d;

class TrackSolver {
 public:
  TrackSolver(std::span<const View> views, const std::vector<Observation>& track)
      : views_(views), track_(track) {}

  /// The best supported point and, in `used`, the indices of the observations that agree.
  std::optional<Eigen::Vector3d> solve(std::vector<std::size_t>* used) const {
    std::optional<Eigen::Vector3d> point = best_of_pairs();
    for (int round = 0; point && round < kRounds; ++round) {
      *used = agreeing(*point).observations;
      if (used->size() < kMinViews) return std::nullopt;
      point = adjust(*point, *used);
    }
    if (!point || agreeing(*point).observations != *used) return std::nullopt;
    return point;
  }

 private:
  struct Agreement {
    std::vector<std::size_t> observations;  ///< the nearest of each view, ascending by view
    double cost = 0.0;                      ///< sum of squares, in tolerances

    bool operator>(const Agreement& other) const {
      if (observations.size() != other.observations.size()) {
        return observations.size() > other.observations.size();
      }
      return cost < other.cost;
    }
  };

  const View& view_of(std::size_t i) const { return views_[track_[i].view]; }

  /// Squared distance between where an observation is and where the point should be seen.
  double error2(std::size_t i, const Eigen::Vector3d& point) const {
    const View& view = view_of(i);
    const auto pixel = view.camera->project(view.camera_from_world * point);
    if (!pixel) return std::numeric_limits<double>::infinity();
    return (*pixel - track_[i].pixel).squaredNorm() / (view.tolerance_px * view.tolerance_px);
  }

  Agreement agreeing(const Eigen::Vector3d& point) const {
    Agreement agreement;
    for (std::size_t i = 0; i < track_.size();) {
      std::size_t nearest = i;
      double least = std::numeric_limits<double>::infinity();
      const std::size_t view = track_[i].view;
      for (; i < track_.size() && track_[i].view == view; ++i) {
        const double error = error2(i, point);
        if (error < least) {
          least = error;
          nearest = i;
        }
      }
      if (!(least <= 1.0)) continue;
      agreement.observations.push_back(nearest);
      agreement.cost += least;
    }
    return agreement;
  }

  std::optional<Eigen::Vector3d> best_of_pairs() const {
    std::optional<Eigen::Vector3d> best;
    Agreement most;
    const std::size_t pairs = track_.size() * (track_.size() - 1) / 2;
    const std::size_t stride = (pairs + kMaxPairs - 1) / kMaxPairs;
    std::size_t pair = 0;
    for (std::size_t i = 0; i < track_.size(); ++i) {
      for (std::size_t j = i + 1; j < track_.size(); ++j) {
        if (pair++ % stride != 0 || track_[i].view == track_[j].view) continue;
        const geometry::Pose& a = view_of(i).camera_from_world;
        const geometry::Pose& b = view_of(j).camera_from_world;
        const auto point = geometry::triangulate(a, b, track_[i].bearing, track_[j].bearing);
        if (!point || geometry::parallax_angle(a, b, *point) < kMinParallax) continue;
        Agreement agreement = agreeing(*point);
        if (best && !(agreement > most)) continue;
        best = point;
        most = std::move(agreement);
      }
    }
    return best;
  }

  /// Least squares over the observations in `used`; none if the distance stays uncertain.
  std::optional<Eigen::Vector3d> adjust(const Eigen::Vector3d& start,
                                        const std::vector<std::size_t>& used) const {
    const geometry::Pose& reference = view_of(used.front()).camera_from_world;
    const geometry::Pose world_from_reference = reference.inverse();
    const Eigen::Vector3d in_reference = reference * start;
    const double unit = in_reference.z();
    const auto linearise = [&](const InverseDepth& state) {
      geometry::NormalEquations<3> sum;
      for (const std::size_t i : used) {
        const geometry::Pose from_reference = view_of(i).camera_from_world * world_from_reference;
        add(i, {from_reference.rotation, from_reference.translation / unit}, state, &sum);
      }
      return sum;
    };
    const auto retract = [](const InverseDepth& state, const Eigen::Vector3d& step) {
      return InverseDepth(state + step);
    };
    const InverseDepth state =
        geometry::minimise<3>(InverseDepth(in_reference.x() / unit, in_reference.y() / unit, 1.0),
                              linearise, retract, kIterations);
    const Eigen::FullPivLU<Eigen::Matrix3d> hessian(linearise(state).hessian);
    if (!(state.z() > 0.0) || !hessian.isInvertible()) return std::nullopt;
    const double sigma = kSigmaShare * std::sqrt(hessian.inverse()(2, 2));
    if (!(sigma <= kMaxDepthSigma * state.z())) return std::nullopt;
    return world_from_reference * (Eigen::Vector3d(state.x(), state.y(), 1.0) * unit / state.z());
  }

  /// One observation's part of the equations, in tolerances. The point enters times its inverse
  /// depth, which does not change its pixel.
  void add(std::size_t i, const geometry::Pose& view_from_reference, const InverseDepth& state,
           geometry::NormalEquations<3>* sum) const {
    const View& view = view_of(i);
    Eigen::Matrix3d point_by_state = view_from_reference.matrix3();
    const Eigen::Vector3d point = point_by_state * Eigen::Vector3d(state.x(), state.y(), 1.0) +
                                  state.z() * view_from_reference.translation;
    point_by_state.col(2) = view_from_reference.translation;
    Eigen::Matrix<double, 2, 3> pixel_by_point;
    const auto pixel = view.camera->project(point, &pixel_by_point);
    if (!pixel) {
      sum->cost = std::numeric_limits<double>::infinity();  // no step may lead behind a camera
      return;
    }
    sum->add<2>((*pixel - track_[i].pixel) / view.tolerance_px,
                pixel_by_point * point_by_state / view.tolerance_px);
  }

  std::span<const View> views_;
  const std::vector<Observation>& track_;
};

}  // namespace

std::vector<TrackPoint> triangulate_track(std::span<const View> views,
                                          std::vector<Observation> track) {
  std::stable_sort(track.begin(), track.end(),
                   [](const auto& a, const auto& b) { return a.view < b.view; });
  std::vector<TrackPoint> points;
  while (track.size() >= kMinViews) {
    std::vector<std::size_t> used;
    const auto point = TrackSolver(views, track).solve(&used);
    if (!point) break;
    points.push_back({*point, {}});
    for (const std::size_t i : used) points.back().views.push_back(track[i].view);
    for (auto i = used.rbegin(); i != used.rend(); ++i) {
      track.erase(track.begin() + static_cast<std::ptrdiff_t>(*i));
    }
  }
  return points;
}

}  // namespace lumibox::lightfield
