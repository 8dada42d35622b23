#include "calibration/uncertainty.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "geometry/camera.h"

namespace lumibox::calibration {
namespace {

constexpr Parameter kOpencv[] = {
    {"fx", &config::CameraProfile::fx}, {"fy", &config::CameraProfile::fy},
    {"cx", &config::CameraProfile::cx}, {"cy", &config::CameraProfile::cy},
    {"k1", &config::CameraProfile::k1}, {"k2", &config::CameraProfile::k2},
    {"p1", &config::CameraProfile::p1}, {"p2", &config::CameraProfile::p2},
    {"k3", &config::CameraProfile::k3}};
constexpr Parameter kFisheye[] = {
    {"fx", &config::CameraProfile::fx}, {"fy", &config::CameraProfile::fy},
    {"cx", &config::CameraProfile::cx}, {"cy", &config::CameraProfile::cy},
    {"k1", &config::CameraProfile::k1}, {"k2", &config::CameraProfile::k2},
    {"k3", &config::CameraProfile::k3}, {"k4", &config::CameraProfile::k4}};

/// Two cameras that differ in one parameter, for a central difference.
struct Nudged {
  geometry::Camera less;
  geometry::Camera more;
  double step;
};

std::vector<Nudged> nudge(const config::CameraProfile& profile) {
  std::vector<Nudged> cameras;
  for (const Parameter& parameter : parameters_of(profile.model)) {
    // Coefficients are of the order of 1, lengths of hundreds: the cube root of the precision.
    const double step = 1e-5 * std::max(1.0, std::abs(profile.*parameter.member));
    config::CameraProfile less = profile;
    config::CameraProfile more = profile;
    less.*parameter.member -= step;
    more.*parameter.member += step;
    cameras.push_back({geometry::Camera(less), geometry::Camera(more), step});
  }
  return cameras;
}

/// Normal equations of all views, each view's pose eliminated (Schur complement).
struct Information {
  Eigen::MatrixXd lens;
  double squares = 0.0;
  double residuals = 0.0;
};

/// False if the lens does not see a corner.
bool add_view(const Board& board, const Sighting& sighting, const geometry::Camera& camera,
              const std::vector<Nudged>& nudged, const geometry::Pose& camera_from_board,
              Information& information) {
  const Eigen::Index n = information.lens.rows();
  Eigen::MatrixXd lens_by_pose = Eigen::MatrixXd::Zero(n, 6);
  geometry::Matrix6d pose = geometry::Matrix6d::Zero();
  for (const Corner& corner : sighting) {
    const Eigen::Vector2d place = corner_on_board(board, corner.id);
    const Eigen::Vector3d point = camera_from_board * Eigen::Vector3d(place.x(), place.y(), 0.0);
    Eigen::Matrix<double, 2, 3> by_point;
    const auto pixel = camera.project(point, &by_point);
    if (!pixel) return false;
    Eigen::Matrix<double, 2, 6> by_pose;
    by_pose << by_point, -by_point * geometry::skew(point);
    Eigen::Matrix<double, 2, Eigen::Dynamic> by_lens(2, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Nudged& pair = nudged[static_cast<std::size_t>(i)];
      const auto less = pair.less.project(point);
      const auto more = pair.more.project(point);
      if (!less || !more) return false;
      by_lens.col(i) = (*more - *less) / (2.0 * pair.step);
    }
    information.lens += by_lens.transpose() * by_lens;
    lens_by_pose += by_lens.transpose() * by_pose;
    pose += by_pose.transpose() * by_pose;
    information.squares += (*pixel - corner.pixel).squaredNorm();
  }
  information.residuals += 2.0 * static_cast<double>(sighting.size());
  information.lens -= lens_by_pose * pose.ldlt().solve(lens_by_pose.transpose());
  return true;
}

}  // namespace

std::span<const Parameter> parameters_of(config::LensModel model) {
  return model == config::LensModel::Fisheye ? std::span<const Parameter>(kFisheye)
                                             : std::span<const Parameter>(kOpencv);
}

std::vector<double> standard_deviations(const Board& board, std::span<const Sighting> sightings,
                                        const LensFit& fit) {
  const std::size_t count = parameters_of(fit.profile.model).size();
  const auto n = static_cast<Eigen::Index>(count);
  const std::vector<double> unknown(count, std::numeric_limits<double>::infinity());
  const geometry::Camera camera(fit.profile);
  const std::vector<Nudged> nudged = nudge(fit.profile);
  Information information{Eigen::MatrixXd::Zero(n, n)};
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (!add_view(board, sightings[i], camera, nudged, fit.camera_from_board[i], information)) {
      return unknown;
    }
  }
  const double freedom = information.residuals - static_cast<double>(count + 6 * sightings.size());
  const Eigen::LDLT<Eigen::MatrixXd> solver(information.lens);
  if (!(freedom > 0.0) || !solver.isPositive()) return unknown;
  const Eigen::MatrixXd covariance =
      information.squares / freedom * solver.solve(Eigen::MatrixXd::Identity(n, n));
  std::vector<double> deviations;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double variance = covariance(i, i);
    deviations.push_back(variance >= 0.0 ? std::sqrt(variance) : unknown.front());
  }
  return deviations;
}

}  // namespace lumibox::calibration
