#include "geometry/multi_view.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "geometry/robust.h"

namespace lumibox::geometry {
namespace {

using Matrix23 = Eigen::Matrix<double, 2, 3>;
using Matrix26 = Eigen::Matrix<double, 2, 6>;

constexpr double kHuber = 2.0;    // in standard deviations
constexpr double kTukey = 4.685;  // the same
constexpr int kRounds = 3;        // the noise is estimated anew before each
constexpr double kGain = 1e-4;    // of the cost; of thousands of errors, a step for less is noise

/// What an error counts. The first round takes all points along, wherever it starts; the later ones
/// know the noise and leave outliers alone.
struct Loss {
  double sigma = 1.0;
  bool redescending = false;

  double cost(double error) const {
    if (redescending) {
      const double weight = tukey_weight(error, kTukey * sigma);
      return kTukey * kTukey / 3.0 * (1.0 - weight * std::sqrt(weight));
    }
    const double length = error / sigma;
    return length < kHuber ? length * length : kHuber * (2.0 * length - kHuber);
  }
  double weight(double error) const {
    return redescending ? tukey_weight(error, kTukey * sigma) : huber_weight(error, kHuber * sigma);
  }
};

/// Normal equations with a camera of six parameters per view (translation, then rotation from the
/// left) and one parameter per point.
struct Equations {
  Eigen::MatrixXd cameras;   ///< block diagonal
  Eigen::VectorXd gradient;  ///< of the cameras
  Eigen::MatrixXd mixed;     ///< column per point
  Eigen::VectorXd points;    ///< diagonal of the points' block
  Eigen::VectorXd point_gradient;
  double cost = 0.0;
};

class Adjustment {
 public:
  explicit Adjustment(const std::vector<std::vector<Eigen::Vector3d>>& bearings)
      : first_(bearings.front()), views_(bearings.size() - 1) {
    for (std::size_t v = 0; v < views_; ++v) {
      for (const Eigen::Vector3d& seen : bearings[v + 1]) {
        across_.push_back(tangent_basis(seen).transpose());
      }
    }
  }

  /// Components of all errors, view by view.
  std::vector<double> residuals(const MultiView& state) const {
    std::vector<double> result;
    result.reserve(2 * across_.size());
    for (std::size_t v = 0; v < views_; ++v) {
      const Eigen::Matrix3d rotation = state.view_from_first[v].matrix3();
      for (std::size_t i = 0; i < first_.size(); ++i) {
        const Eigen::Vector3d ray =
            rotation * first_[i] + state.inverse_distance[i] * state.view_from_first[v].translation;
        const Eigen::Vector2d error = across(v, i) * ray.normalized();
        result.push_back(error.x());
        result.push_back(error.y());
      }
    }
    return result;
  }

  double cost(const MultiView& state, const Loss& loss) const {
    const std::vector<double> r = residuals(state);
    double sum = 0.0;
    for (std::size_t k = 0; k < r.size(); k += 2) sum += loss.cost(std::hypot(r[k], r[k + 1]));
    return sum;
  }

  Equations linearise(const MultiView& state, const Loss& loss) const {
    const auto dimension = static_cast<Eigen::Index>(6 * views_);
    const auto count = static_cast<Eigen::Index>(first_.size());
    Equations e{Eigen::MatrixXd::Zero(dimension, dimension), Eigen::VectorXd::Zero(dimension),
                Eigen::MatrixXd::Zero(dimension, count), Eigen::VectorXd::Zero(count),
                Eigen::VectorXd::Zero(count)};
    for (std::size_t v = 0; v < views_; ++v) {
      const Eigen::Matrix3d rotation = state.view_from_first[v].matrix3();
      const Eigen::Vector3d& translation = state.view_from_first[v].translation;
      const auto at = static_cast<Eigen::Index>(6 * v);
      Matrix6d block = Matrix6d::Zero();
      Vector6d slope = Vector6d::Zero();
      for (std::size_t i = 0; i < first_.size(); ++i) {
        const auto column = static_cast<Eigen::Index>(i);
        const double inverse = state.inverse_distance[i];
        const Eigen::Vector3d turned = rotation * first_[i];
        const Eigen::Vector3d ray = turned + inverse * translation;
        const double length = ray.norm();
        const Eigen::Vector3d direction = ray / length;
        const Eigen::Vector2d error = across(v, i) * direction;
        const Matrix23 by_ray = (across(v, i) - error * direction.transpose()) / length;
        Matrix26 by_camera;
        by_camera << inverse * by_ray, -by_ray * skew(turned);
        const Eigen::Vector2d by_point = by_ray * translation;
        const double weight = loss.weight(error.norm());
        block.noalias() += weight * by_camera.transpose() * by_camera;
        slope.noalias() += weight * by_camera.transpose() * error;
        e.mixed.block<6, 1>(at, column) = weight * by_camera.transpose() * by_point;
        e.points[column] += weight * by_point.squaredNorm();
        e.point_gradient[column] += weight * by_point.dot(error);
      }
      e.cameras.block<6, 6>(at, at) = block;
      e.gradient.segment<6>(at) = slope;
    }
    return e;
  }

 private:
  const Matrix23& across(std::size_t view, std::size_t point) const {
    return across_[view * first_.size() + point];
  }

  const std::vector<Eigen::Vector3d>& first_;
  std::size_t views_;
  std::vector<Matrix23> across_;  // rows span the plane across each bearing seen
};

/// The cameras' equations with the points eliminated, and the points' inverse diagonal.
struct Reduced {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
  Eigen::VectorXd inverse_points;
};

Reduced reduce(const Equations& e, double damping) {
  Reduced r;
  // A point that weighs nothing, an outlier in every view, stays where it is.
  r.inverse_points = e.points.unaryExpr(
      [damping](double h) { return h > 0.0 ? 1.0 / (h * (1.0 + damping)) : 0.0; });
  const Eigen::MatrixXd weighted = e.mixed * r.inverse_points.asDiagonal();
  r.matrix = e.cameras;
  r.matrix.diagonal() *= 1.0 + damping;
  r.matrix.noalias() -= weighted * e.mixed.transpose();
  r.gradient = e.gradient - weighted * e.point_gradient;
  return r;
}

/// Scale is free, its sign too: mirrored through the first camera, centres and points look the
/// same. Most points are put in front.
void set_unit_of_length(MultiView& state) {
  double longest = 0.0;
  for (const Pose& pose : state.view_from_first) {
    longest = std::max(longest, pose.translation.norm());
  }
  if (!(longest > 0.0)) return;
  const auto behind =
      std::ranges::count_if(state.inverse_distance, [](double inverse) { return inverse < 0.0; });
  if (2 * static_cast<std::size_t>(behind) > state.inverse_distance.size()) longest = -longest;
  for (Pose& pose : state.view_from_first) pose.translation /= longest;
  for (double& inverse : state.inverse_distance) inverse *= longest;
}

MultiView stepped(const MultiView& state, const Eigen::VectorXd& cameras,
                  const Eigen::VectorXd& points) {
  MultiView next = state;
  for (std::size_t v = 0; v < next.view_from_first.size(); ++v) {
    const auto at = static_cast<Eigen::Index>(6 * v);
    Pose& pose = next.view_from_first[v];
    pose.translation += cameras.segment<3>(at);
    pose.rotation = (exp_so3(cameras.segment<3>(at + 3)) * pose.rotation).normalized();
  }
  for (std::size_t i = 0; i < next.inverse_distance.size(); ++i) {
    next.inverse_distance[i] += points[static_cast<Eigen::Index>(i)];
  }
  set_unit_of_length(next);
  return next;
}

/// Leaves the last translation its length only.
void hold_last_direction(const MultiView& state, Equations& equations) {
  const Eigen::Vector3d along = state.view_from_first.back().translation.normalized();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along * along.transpose();
  const auto at = equations.cameras.rows() - 6;
  equations.cameras.block<3, 3>(at, at) += 1e6 * equations.cameras.diagonal().maxCoeff() * across;
}

MultiView minimise_cost(const Adjustment& problem, MultiView state, const Loss& loss,
                        int max_iterations, MotionFreedom freedom) {
  double here = problem.cost(state, loss);
  double damping = 1e-2;  // a valley leads from a motion to its dual: no leap along it
  for (int i = 0; i < max_iterations; ++i) {
    Equations equations = problem.linearise(state, loss);
    if (freedom == MotionFreedom::LastDirectionHeld) hold_last_direction(state, equations);
    bool improved = false;
    double there = here;
    for (int attempt = 0; attempt < 5 && !improved; ++attempt) {
      const Reduced reduced = reduce(equations, damping);
      const Eigen::VectorXd cameras = -reduced.matrix.ldlt().solve(reduced.gradient);
      const Eigen::VectorXd points = -reduced.inverse_points.cwiseProduct(
          equations.point_gradient + equations.mixed.transpose() * cameras);
      if (cameras.allFinite() && points.allFinite()) {
        MultiView next = stepped(state, cameras, points);
        there = problem.cost(next, loss);
        improved = there < here;
        if (improved) state = std::move(next);
      }
      damping = improved ? std::max(0.1 * damping, 1e-8) : 10.0 * damping;
    }
    if (!improved) break;
    const bool converged = here - there < kGain * here;
    here = there;
    if (converged) break;
  }
  return state;
}

double noise_of(const Adjustment& problem, const MultiView& state) {
  const std::vector<double> r = problem.residuals(state);
  const auto observed = static_cast<double>(r.size());
  const double estimated = static_cast<double>(state.inverse_distance.size()) +
                           6.0 * static_cast<double>(state.view_from_first.size()) - 1.0;
  const double freedom = std::max(1.0, observed - estimated);
  return std::max(1e-9, mad_sigma(r) * std::sqrt(observed / freedom));
}

/// Covariance of the inverse distances: each point's own noise plus what it inherits from the
/// cameras. A change of scale, points x (1 + e), is projected out of both.
void set_point_sigmas(const Adjustment& problem, MultiView& state) {
  const Equations equations = problem.linearise(state, {state.sigma_rad, true});
  Reduced reduced = reduce(equations, 0.0);
  Eigen::VectorXd gauge = Eigen::VectorXd::Zero(reduced.gradient.size());
  for (std::size_t v = 0; v < state.view_from_first.size(); ++v) {
    gauge.segment<3>(static_cast<Eigen::Index>(6 * v)) = state.view_from_first[v].translation;
  }
  // Any weight gives the same once scale is projected out; this one keeps the matrix well scaled.
  if (gauge.squaredNorm() > 0.0) {
    reduced.matrix += gauge * gauge.transpose() * (reduced.matrix.trace() / gauge.squaredNorm());
  }
  const Eigen::MatrixXd cameras = reduced.matrix.ldlt().solve(
      Eigen::MatrixXd::Identity(reduced.matrix.rows(), reduced.matrix.cols()));
  const Eigen::Map<const Eigen::VectorXd> inverse(
      state.inverse_distance.data(), static_cast<Eigen::Index>(state.inverse_distance.size()));
  const Eigen::VectorXd unit =
      (reduced.inverse_points.array() > 0.0).select(inverse, 0.0).matrix().normalized();
  const Eigen::VectorXd& own = reduced.inverse_points;
  Eigen::MatrixXd inherited = reduced.inverse_points.asDiagonal() * equations.mixed.transpose();
  inherited -= unit * (unit.transpose() * inherited);
  const double common = own.dot(unit.cwiseAbs2());
  state.inverse_distance_sigma.clear();
  for (Eigen::Index i = 0; i < inverse.size(); ++i) {
    const double square = unit[i] * unit[i];
    const double variance = own[i] * (1.0 - 2.0 * square) + square * common +
                            inherited.row(i).dot(cameras * inherited.row(i).transpose());
    state.inverse_distance_sigma.push_back(own[i] > 0.0 ? state.sigma_rad *
                                                              std::sqrt(std::max(0.0, variance))
                                                        : std::numeric_limits<double>::infinity());
  }
}

void set_errors(const Adjustment& problem, MultiView& state) {
  const std::vector<double> r = problem.residuals(state);
  const std::size_t count = state.inverse_distance.size();
  const std::size_t views = state.view_from_first.size();
  state.squared_errors.assign(count, 0.0);
  for (std::size_t k = 0; k < r.size(); k += 2) {
    state.squared_errors[(k / 2) % count] +=
        (r[k] * r[k] + r[k + 1] * r[k + 1]) / static_cast<double>(views);
  }
}

}  // namespace

MultiView adjust_multi_view(const std::vector<std::vector<Eigen::Vector3d>>& bearings,
                            const MultiView& start, int max_iterations, MotionFreedom freedom) {
  const Adjustment problem(bearings);
  MultiView state = start;
  set_unit_of_length(state);
  for (int round = 0; round < kRounds; ++round) {
    const Loss loss{noise_of(problem, state), round > 0};
    state = minimise_cost(problem, std::move(state), loss, max_iterations, freedom);
  }
  state.sigma_rad = noise_of(problem, state);
  set_errors(problem, state);
  set_point_sigmas(problem, state);
  return state;
}

double relative_depth_sigma(const MultiView& views) {
  std::vector<double> relative;
  for (std::size_t i = 0; i < views.inverse_distance.size(); ++i) {
    const double magnitude = std::abs(views.inverse_distance[i]);
    relative.push_back(magnitude > 0.0 ? views.inverse_distance_sigma[i] / magnitude
                                       : std::numeric_limits<double>::infinity());
  }
  return median(std::move(relative));
}

}  // namespace lumibox::geometry
