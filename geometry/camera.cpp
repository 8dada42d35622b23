#include "geometry/camera.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace lumibox::geometry {
namespace {

struct Distorted {
  Eigen::Vector2d point;
  Eigen::Matrix2d jacobian;
};

/// Factor by which a radius changes, and its derivative by the squared radius.
struct Radial {
  double factor = 1.0;
  double slope = 0.0;
};

Radial polynomial(const config::CameraProfile& c, double r2) {
  return {1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3)), c.k1 + r2 * (2.0 * c.k2 + r2 * 3.0 * c.k3)};
}

/// Kannala and Brandt (2006), equation 6, as cv::fisheye has it: distance from the principal point,
/// in focal lengths, of a ray at the angle theta to the optical axis; and its derivative by theta.
double fisheye_radius(const config::CameraProfile& c, double theta) {
  const double t2 = theta * theta;
  return theta * (1.0 + t2 * (c.k1 + t2 * (c.k2 + t2 * (c.k3 + t2 * c.k4))));
}
double fisheye_slope(const config::CameraProfile& c, double theta) {
  const double t2 = theta * theta;
  return 1.0 + t2 * (3.0 * c.k1 + t2 * (5.0 * c.k2 + t2 * (7.0 * c.k3 + t2 * 9.0 * c.k4)));
}

Radial fisheye(const config::CameraProfile& c, double r2) {
  constexpr double kOnTheAxis = 1e-30;  // below, the factor is 1 to the last bit
  if (r2 < kOnTheAxis) return {};
  const double r = std::sqrt(r2);
  const double theta = std::atan(r);
  const double factor = fisheye_radius(c, theta) / r;
  return {factor, (fisheye_slope(c, theta) / (1.0 + r2) - factor) / (2.0 * r2)};
}

Distorted distort_normalised(const config::CameraProfile& c, const Eigen::Vector2d& n) {
  const double x = n.x();
  const double y = n.y();
  const double r2 = x * x + y * y;
  const auto [radial, slope] =
      c.model == config::LensModel::Fisheye ? fisheye(c, r2) : polynomial(c, r2);
  Distorted d;
  d.point.x() = x * radial + 2.0 * c.p1 * x * y + c.p2 * (r2 + 2.0 * x * x);
  d.point.y() = y * radial + c.p1 * (r2 + 2.0 * y * y) + 2.0 * c.p2 * x * y;
  d.jacobian(0, 0) = radial + 2.0 * x * x * slope + 2.0 * c.p1 * y + 6.0 * c.p2 * x;
  d.jacobian(0, 1) = 2.0 * x * y * slope + 2.0 * c.p1 * x + 2.0 * c.p2 * y;
  d.jacobian(1, 0) = d.jacobian(0, 1);
  d.jacobian(1, 1) = radial + 2.0 * y * y * slope + 6.0 * c.p1 * y + 2.0 * c.p2 * x;
  return d;
}

/// Smallest x in (0, end] at which a function that begins above zero is not, by a scan and
/// bisection; none if there is none.
template <typename Function>
std::optional<double> first_zero(double end, const Function& function) {
  constexpr int kSteps = 2000;
  for (int i = 1; i <= kSteps; ++i) {
    double low = end * (i - 1) / kSteps;
    double high = end * i / kSteps;
    if (function(high) > 0.0) continue;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (function(middle) <= 0.0 ? high : low) = middle;
    }
    return low;
  }
  return std::nullopt;
}

/// Least determinant of the distortion's derivative among all directions at the radius r. With the
/// decentring p = (p2, p1) at the angle phi to the direction, the derivative in the basis (along,
/// across) is
///     | g + 6 |p| r cos(phi)         2 |p| r sin(phi)     |
///     | 2 |p| r sin(phi)       radial + 2 |p| r cos(phi)  |
/// with g = d(r radial)/dr = 1 + 3 k1 r2 + 5 k2 r4 + 7 k3 r6: a quadratic in cos(phi).
double least_determinant(const config::CameraProfile& c, double r) {
  const double r2 = r * r;
  const double radial = polynomial(c, r2).factor;
  const double g = 1.0 + r2 * (3.0 * c.k1 + r2 * (5.0 * c.k2 + r2 * 7.0 * c.k3));
  const double pr = std::hypot(c.p1, c.p2) * r;
  const double linear = (2.0 * g + 6.0 * radial) * pr;
  const double lowest = pr > 0.0 ? std::clamp(-linear / (32.0 * pr * pr), -1.0, 1.0) : 0.0;
  return g * radial - 4.0 * pr * pr + lowest * (linear + 16.0 * pr * pr * lowest);
}

/// Squared radius inside which no direction has a fold, in every field of view a rectilinear lens
/// can have (r <= 10 is 168 degrees).
double find_fold(const config::CameraProfile& c) {
  const auto fold = first_zero(10.0, [&c](double r) { return least_determinant(c, r); });
  return fold ? *fold * *fold : std::numeric_limits<double>::infinity();
}

/// The same of a fisheye lens. It may see behind itself, but beyond a twentieth of a degree before
/// the image plane normalised coordinates say nothing any more.
double find_fisheye_fold(const config::CameraProfile& c) {
  constexpr double kLargestRadius = 1000.0;
  const double end = std::atan(kLargestRadius);
  const auto fold = first_zero(end, [&c](double theta) { return fisheye_slope(c, theta); });
  const double r = std::tan(fold.value_or(end));
  return r * r;
}

double fold_of(const config::CameraProfile& c, bool has_distortion) {
  if (c.model == config::LensModel::Fisheye) return find_fisheye_fold(c);
  return has_distortion ? find_fold(c) : std::numeric_limits<double>::infinity();
}

/// Normalised coordinates of distorted ones. On the way to the fold the radius only grows with the
/// angle, so Newton's method is kept between bounds that close in on the answer.
std::optional<Eigen::Vector2d> unproject_fisheye(const config::CameraProfile& c,
                                                 const Eigen::Vector2d& target,
                                                 double fold_radius2) {
  const double radius = target.norm();
  if (radius < 1e-15) return target;
  double low = 0.0;
  double high = std::atan(std::sqrt(fold_radius2));
  if (!(radius < fisheye_radius(c, high))) return std::nullopt;
  double theta = std::min(radius, 0.5 * high);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double error = fisheye_radius(c, theta) - radius;
    if (std::abs(error) < 1e-15) break;
    (error > 0.0 ? high : low) = theta;
    const double newton = theta - error / std::max(fisheye_slope(c, theta), 1e-12);
    theta = newton > low && newton < high ? newton : 0.5 * (low + high);
  }
  return target * (std::tan(theta) / radius);
}

}  // namespace

Camera::Camera(const config::CameraProfile& profile)
    : profile_(profile),
      has_distortion_(profile.model == config::LensModel::Fisheye || profile.k1 != 0.0 ||
                      profile.k2 != 0.0 || profile.p1 != 0.0 || profile.p2 != 0.0 ||
                      profile.k3 != 0.0),
      fold_radius2_(fold_of(profile, has_distortion_)) {}

std::optional<Eigen::Vector2d> Camera::project(const Eigen::Vector3d& p) const {
  if (!(p.z() > 0.0)) return std::nullopt;
  const Eigen::Vector2d n(p.x() / p.z(), p.y() / p.z());
  if (!has_distortion_) {
    return Eigen::Vector2d(profile_.fx * n.x() + profile_.cx, profile_.fy * n.y() + profile_.cy);
  }
  if (!(n.squaredNorm() < fold_radius2_)) return std::nullopt;
  return distort(n);
}

std::optional<Eigen::Vector2d> Camera::project(const Eigen::Vector3d& p,
                                               Eigen::Matrix<double, 2, 3>* jacobian) const {
  if (!(p.z() > 0.0)) return std::nullopt;
  const double inverse_z = 1.0 / p.z();
  const Eigen::Vector2d n(p.x() * inverse_z, p.y() * inverse_z);
  if (!(n.squaredNorm() < fold_radius2_)) return std::nullopt;
  Distorted d{n, Eigen::Matrix2d::Identity()};
  if (has_distortion_) d = distort_normalised(profile_, n);
  Eigen::Matrix<double, 2, 3> normalised_by_point;
  normalised_by_point << inverse_z, 0.0, -n.x() * inverse_z, 0.0, inverse_z, -n.y() * inverse_z;
  *jacobian =
      Eigen::Vector2d(profile_.fx, profile_.fy).asDiagonal() * d.jacobian * normalised_by_point;
  return Eigen::Vector2d(profile_.fx * d.point.x() + profile_.cx,
                         profile_.fy * d.point.y() + profile_.cy);
}

std::optional<Eigen::Vector2d> Camera::unproject(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d target((pixel.x() - profile_.cx) / profile_.fx,
                               (pixel.y() - profile_.cy) / profile_.fy);
  if (!target.allFinite()) return std::nullopt;
  if (!has_distortion_) return target;
  if (profile_.model == config::LensModel::Fisheye) {
    return unproject_fisheye(profile_, target, fold_radius2_);
  }
  Eigen::Vector2d n = target;
  // Start inside the fold, where Newton's method stays on the branch that a lens can see.
  if (n.squaredNorm() >= fold_radius2_) n *= 0.9 * std::sqrt(fold_radius2_ / n.squaredNorm());
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Distorted d = distort_normalised(profile_, n);
    const Eigen::Vector2d error = d.point - target;
    if (error.squaredNorm() < 1e-26) break;
    const double determinant = d.jacobian.determinant();
    if (!(std::abs(determinant) > 1e-12)) return std::nullopt;
    Eigen::Vector2d step = d.jacobian.inverse() * error;
    Eigen::Vector2d next = n - step;
    for (int halving = 0; halving < 30 && !(next.squaredNorm() < fold_radius2_); ++halving) {
      step *= 0.5;
      next = n - step;
    }
    n = next;
  }
  if (!(n.squaredNorm() < fold_radius2_)) return std::nullopt;
  if (!((distort_normalised(profile_, n).point - target).squaredNorm() < 1e-20)) {
    return std::nullopt;
  }
  return n;
}

Eigen::Vector2d Camera::distort(const Eigen::Vector2d& normalised) const {
  const Eigen::Vector2d d = distort_normalised(profile_, normalised).point;
  return {profile_.fx * d.x() + profile_.cx, profile_.fy * d.y() + profile_.cy};
}

Eigen::Matrix3d Camera::pinhole_matrix() const {
  Eigen::Matrix3d m;
  m << profile_.fx, 0.0, profile_.cx, 0.0, profile_.fy, profile_.cy, 0.0, 0.0, 1.0;
  return m;
}

std::optional<Eigen::Vector2d> Camera::corner_beyond_fold() const {
  if (profile_.model == config::LensModel::Fisheye) return std::nullopt;
  for (const double x : {0.0, profile_.width - 1.0}) {
    for (const double y : {0.0, profile_.height - 1.0}) {
      if (!unproject({x, y})) return Eigen::Vector2d(x, y);
    }
  }
  return std::nullopt;
}

Camera Camera::at_level(int level) const {
  config::CameraProfile p = profile_;
  for (int i = 0; i < level; ++i) {
    p.fx *= 0.5;
    p.fy *= 0.5;
    p.cx = 0.5 * p.cx - 0.25;
    p.cy = 0.5 * p.cy - 0.25;
    p.width /= 2;
    p.height /= 2;
  }
  return Camera(p);
}

Camera Camera::undistorted() const {
  config::CameraProfile p = profile_;
  p.model = config::LensModel::Opencv;
  p.k1 = p.k2 = p.p1 = p.p2 = p.k3 = p.k4 = 0.0;
  return Camera(p);
}

}  // namespace lumibox::geometry
