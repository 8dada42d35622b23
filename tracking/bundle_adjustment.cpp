#include "tracking/bundle_adjustment.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>

#include "geometry/robust.h"
#include "geometry/rotation.h"

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

/// Parameter block of a view: quaternion x y z w, translation.
using PoseBlock = std::array<double, 7>;

PoseBlock to_block(const geometry::Pose& pose) {
  const auto& q = pose.rotation;
  const auto& t = pose.translation;
  return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

/// The same pose where lengths are `scale` times as large.
geometry::Pose scaled(const geometry::Pose& pose, double scale) {
  return {pose.rotation, scale * pose.translation};
}

geometry::Pose from_block(const double* b) {
  return {Eigen::Quaterniond(b[3], b[0], b[1], b[2]).normalized(),
          Eigen::Vector3d(b[4], b[5], b[6])};
}

/// SE(3) with twists from the left. The cost below gives its derivative by the twist directly, in
/// the first six of the seven columns, so the chain through the quaternion is the identity here.
class LeftTwistManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const Eigen::Map<const geometry::Vector6d> twist(delta);
    const PoseBlock moved = to_block(geometry::exp_se3(twist) * from_block(x));
    std::copy(moved.begin(), moved.end(), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* difference) const override {
    Eigen::Map<geometry::Vector6d> twist(difference);
    twist = geometry::log_se3(from_block(y) * from_block(x).inverse());
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
};

class ReprojectionCost : public ceres::SizedCostFunction<2, 7, 3> {
 public:
  ReprojectionCost(const geometry::Camera& camera, const BundleProblem::Observation& observation,
                   double unit)
      : camera_(camera),
        pixel_(observation.pixel),
        row_from_frame_(scaled(observation.row_from_frame, 1.0 / unit)),
        inverse_sigma_(1.0 / observation.sigma_px) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const geometry::Pose camera_from_world = from_block(parameters[0]);
    const Eigen::Map<const Eigen::Vector3d> point(parameters[1]);
    const Eigen::Vector3d p = camera_from_world * point;
    Eigen::Matrix<double, 2, 3> by_point;
    const auto pixel = camera_.project(row_from_frame_ * p, &by_point);
    if (!pixel) return false;  // the solver rejects the step that led here
    Eigen::Map<Eigen::Vector2d> error(residuals);
    error = (*pixel - pixel_) * inverse_sigma_;
    if (jacobians == nullptr) return true;
    by_point *= inverse_sigma_ * row_from_frame_.matrix3();
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 7, Eigen::RowMajor>> j(jacobians[0]);
      j.leftCols<3>() = by_point;
      j.middleCols<3>(3) = -by_point * geometry::skew(p);
      j.col(6).setZero();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>> j(jacobians[1]);
      j = by_point * camera_from_world.matrix3();
    }
    return true;
  }

 private:
  const geometry::Camera& camera_;
  Eigen::Vector2d pixel_;
  geometry::Pose row_from_frame_;
  double inverse_sigma_;
};

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

bool adjust(const geometry::Camera& camera, BundleProblem& problem, int max_iterations) {
  const double unit = unit_of(problem);
  std::vector<PoseBlock> views;
  views.reserve(problem.views.size());
  for (const auto& view : problem.views) {
    views.push_back(to_block(scaled(view.camera_from_world, 1.0 / unit)));
  }
  std::vector<Eigen::Vector3d> points = problem.points;
  for (auto& point : points) point /= unit;

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
    double* view = views[static_cast<std::size_t>(o.view)].data();
    double* point = points[static_cast<std::size_t>(o.point)].data();
    solver.AddResidualBlock(new ReprojectionCost(camera, o, unit), &loss, view, point);
    ordering->AddElementToGroup(point, 0);
    ordering->AddElementToGroup(view, 1);
  }
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!solver.HasParameterBlock(views[i].data())) continue;
    solver.SetManifold(views[i].data(), &manifold);
    if (problem.views[i].fixed) solver.SetParameterBlockConstant(views[i].data());
  }

  ceres::Solver::Options options = solver_options(max_iterations);
  options.linear_solver_ordering = ordering;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &solver, &summary);
  if (!summary.IsSolutionUsable()) return false;

  for (std::size_t i = 0; i < views.size(); ++i) {
    if (problem.views[i].fixed) continue;
    problem.views[i].camera_from_world = scaled(from_block(views[i].data()), unit);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (solver.HasParameterBlock(points[i].data())) problem.points[i] = unit * points[i];
  }
  set_errors(camera, problem);
  return true;
}

}  // namespace lumibox::tracking
