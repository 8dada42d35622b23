#include "tracking/bundle_adjustment.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "geometry/robust.h"
#include "tracking/reprojection_cost.h"

namespace lumibox::tracking {
namespace {

constexpr double kCauchy = 2.385;  // standard deviations: 95 % efficiency (Zhang, "Parameter
                                   // estimation techniques", 1997)

// An observation's sigma is a bound that holds on every level; what is measured well errs by at
// most 0.4 of it, and by less than 0.1 in a simulation without effects. A cost as narrow as that
// would take the points that an orbit meets again for outliers, for they are off by what it has
// drifted: with the focal length wrong by 1 % it would not close.
constexpr double kMaxNoise = 0.42;
constexpr double kMinNoise = 0.2;

constexpr double kFarthest = 1e6;  // of a point, in times the extent of the views

/// Length that the solver measures in: how far the views' centres are from their mean. Its damping
/// and its stopping rule have absolute thresholds, and a monocular world has no scale of its own.
double unit_of(const BundleProblem& problem) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& view : problem.views) mean += view.camera_from_world.inverse().translation;
  mean /= static_cast<double>(std::max<std::size_t>(problem.views.size(), 1));
  double spread = 0.0;
  for (const auto& view : problem.views) {
    spread = std::max(spread, (view.camera_from_world.inverse().translation - mean).norm());
  }
  return spread > 0.0 ? spread : 1.0;
}

/// Pixel at which an observation should be, as the problem stands.
std::optional<Eigen::Vector2d> predict(const geometry::Camera& camera, const BundleProblem& problem,
                                       const BundleProblem::Observation& o) {
  const auto& view = problem.views[static_cast<std::size_t>(o.view)];
  const auto& point = problem.points[static_cast<std::size_t>(o.point)];
  return camera.project(o.row_from_frame * (view.camera_from_world * point));
}

/// Standard deviation of the errors, in sigmas, told by their median. With a rolling shutter it is
/// not told: the motion during the readout is known to the first order only, and its errors, which
/// rows share, are no noise.
double noise_of(const geometry::Camera& camera, const BundleProblem& problem) {
  std::vector<double> errors;
  errors.reserve(problem.observations.size());
  for (const auto& o : problem.observations) {
    if (!o.row_from_frame.translation.isZero()) return kMaxNoise;
    if (const auto pixel = predict(camera, problem, o)) {
      errors.push_back((*pixel - o.pixel).norm() / o.sigma_px);
    }
  }
  return std::clamp(geometry::median(std::move(errors)) / geometry::kMedianLength, kMinNoise,
                    kMaxNoise);
}

void set_errors(const geometry::Camera& camera, BundleProblem& problem) {
  for (auto& o : problem.observations) {
    const auto pixel = predict(camera, problem, o);
    o.error_in_sigma =
        pixel ? (*pixel - o.pixel).norm() / o.sigma_px : std::numeric_limits<double>::infinity();
  }
}

/// Ends the solver between two steps, but not before the first.
class StopWhenEnough : public ceres::IterationCallback {
 public:
  explicit StopWhenEnough(const std::function<bool()>& enough) : enough_(enough) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    const bool stop = enough_ && summary.iteration > 0 && enough_();
    return stop ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const std::function<bool()>& enough_;
};

ceres::Solver::Options solver_options(int max_iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = max_iterations;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = 1e-5;
  return options;
}

}  // namespace

bool adjust(const geometry::Camera& camera, BundleProblem& problem, int max_iterations,
            const std::function<bool()>& enough) {
  const double unit = unit_of(problem);
  std::vector<PoseBlock> views;
  views.reserve(problem.views.size());
  for (const auto& view : problem.views) {
    views.push_back(to_block(scaled(view.camera_from_world, 1.0 / unit)));
  }
  std::vector<std::optional<InverseDepthChart>> charts(problem.points.size());
  std::vector<Eigen::Vector3d> coordinates(problem.points.size());
  std::vector<int> sightings(problem.points.size());

  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  LeftTwistManifold manifold;
  ceres::CauchyLoss loss(kCauchy * noise_of(camera, problem));
  ceres::Problem solver(ownership);
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (const auto& o : problem.observations) {
    // Without a residual at the start the solver would not begin.
    if (!predict(camera, problem, o)) continue;
    const auto index = static_cast<std::size_t>(o.point);
    if (!charts[index]) {
      const auto& first = problem.views[static_cast<std::size_t>(o.view)].camera_from_world;
      charts[index].emplace(first.inverse().translation / unit, problem.points[index] / unit);
      coordinates[index] = charts[index]->coordinates();
    }
    ++sightings[index];
    double* view = views[static_cast<std::size_t>(o.view)].data();
    double* point = coordinates[index].data();
    solver.AddResidualBlock(new ReprojectionCost(camera, *charts[index], o, unit), &loss, view,
                            point);
    ordering->AddElementToGroup(point, 0);
    ordering->AddElementToGroup(view, 1);
  }
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!solver.HasParameterBlock(views[i].data())) continue;
    solver.SetManifold(views[i].data(), &manifold);
    if (problem.views[i].fixed) solver.SetParameterBlockConstant(views[i].data());
  }

  ceres::SubsetManifold at_its_depth(3, {2});
  for (std::size_t i = 0; i < charts.size(); ++i) {  // one sighting says nothing of the depth
    if (sightings[i] == 1) solver.SetManifold(coordinates[i].data(), &at_its_depth);
  }

  ceres::Solver::Options options = solver_options(max_iterations);
  options.linear_solver_ordering = ordering;
  StopWhenEnough stop(enough);
  options.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &solver, &summary);
  if (!summary.IsSolutionUsable()) return false;

  for (std::size_t i = 0; i < views.size(); ++i) {
    if (problem.views[i].fixed) continue;
    problem.views[i].camera_from_world = scaled(from_block(views[i].data()), unit);
  }
  for (std::size_t i = 0; i < charts.size(); ++i) {
    if (charts[i]) problem.points[i] = unit * charts[i]->point(coordinates[i], kFarthest);
  }
  set_errors(camera, problem);
  return true;
}

}  // namespace lumibox::tracking
