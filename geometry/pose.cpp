#include "geometry/pose.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <complex>

namespace lumibox::geometry {
namespace {

/// Left Jacobian of SO(3), V in exp_se3: translation = V * rho.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& omega) {
  const double angle2 = omega.squaredNorm();
  const double angle = std::sqrt(angle2);
  double a = 0.5;        // (1 - cos angle) / angle^2
  double b = 1.0 / 6.0;  // (angle - sin angle) / angle^3
  if (angle < 1e-2) {
    // Both closed forms cancel; three terms of the series leave an error below 1e-16.
    a = 0.5 - angle2 / 24.0 + angle2 * angle2 / 720.0;
    b = 1.0 / 6.0 - angle2 / 120.0 + angle2 * angle2 / 5040.0;
  } else {
    const double half_sine = std::sin(0.5 * angle);
    a = 2.0 * half_sine * half_sine / angle2;
    b = (angle - std::sin(angle)) / (angle2 * angle);
  }
  const Eigen::Matrix3d w = skew(omega);
  return Eigen::Matrix3d::Identity() + a * w + b * w * w;
}

/// (e^z - 1) / z, the integral of e^(z u) over u from 0 to 1.
std::complex<double> mean_exponential(const std::complex<double>& z) {
  if (std::abs(z) > 0.5) return (std::exp(z) - 1.0) / z;
  // The difference above cancels; of the series, the first term left out is below 1e-17.
  std::complex<double> sum = 1.0;
  for (int n = 15; n > 1; --n) sum = 1.0 + sum * z / static_cast<double>(n);
  return sum;
}

/// V in exp_sim3: translation = V * rho, the mean of scale^u R^u over u from 0 to 1. Along the axis
/// that is a mean of e^(sigma u), across it one of e^((sigma + i angle) u). Written with the unit
/// axis instead of Strasdat's three coefficients nothing is divided by the angle's square.
Eigen::Matrix3d mean_similarity(const Eigen::Vector3d& omega, double sigma) {
  const double angle = omega.norm();
  const Eigen::Matrix3d axis = angle > 0.0 ? skew(omega / angle) : Eigen::Matrix3d::Zero();
  const std::complex<double> across = mean_exponential({sigma, angle});
  const double along = mean_exponential(sigma).real();
  return along * Eigen::Matrix3d::Identity() + across.imag() * axis +
         (along - across.real()) * axis * axis;
}

}  // namespace

Eigen::Matrix4d Pose::matrix4() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = matrix3();
  m.topRightCorner<3, 1>() = translation;
  return m;
}

Pose exp_se3(const Vector6d& twist) {
  const Eigen::Vector3d omega = twist.tail<3>();
  return {exp_so3(omega), left_jacobian(omega) * twist.head<3>()};
}

Vector6d log_se3(const Pose& pose) {
  Vector6d twist;
  const Eigen::Vector3d omega = log_so3(pose.rotation);
  twist.tail<3>() = omega;
  twist.head<3>() = left_jacobian(omega).partialPivLu().solve(pose.translation);
  return twist;
}

Similarity Similarity::inverse() const {
  const Eigen::Quaterniond back = rigid.rotation.conjugate();
  return {1.0 / scale, {back, back * rigid.translation * (-1.0 / scale)}};
}

Similarity exp_sim3(const Vector7d& twist) {
  const Eigen::Vector3d omega = twist.segment<3>(3);
  const double sigma = twist[6];
  return {std::exp(sigma), {exp_so3(omega), mean_similarity(omega, sigma) * twist.head<3>()}};
}

Vector7d log_sim3(const Similarity& similarity) {
  const Eigen::Vector3d omega = log_so3(similarity.rigid.rotation);
  const double sigma = std::log(similarity.scale);
  Vector7d twist;
  twist.head<3>() =
      mean_similarity(omega, sigma).partialPivLu().solve(similarity.rigid.translation);
  twist.segment<3>(3) = omega;
  twist[6] = sigma;
  return twist;
}

Similarity align_umeyama(const Eigen::Matrix3Xd& source, const Eigen::Matrix3Xd& target) {
  Similarity result;
  if (source.cols() == 0) return result;
  const Eigen::Vector3d mean_source = source.rowwise().mean();
  const Eigen::Vector3d mean_target = target.rowwise().mean();
  const Eigen::Matrix3Xd s = source.colwise() - mean_source;
  const Eigen::Matrix3Xd t = target.colwise() - mean_target;

  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(t * s.transpose(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1.0, 1.0, 1.0);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) sign.z() = -1.0;
  const Eigen::Matrix3d rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  const double spread = s.squaredNorm();
  if (spread > 0.0) {
    const double scale = svd.singularValues().dot(sign) / spread;
    if (scale > 0.0) result.scale = scale;
  }
  result.rigid = Pose(rotation, mean_target - result.scale * (rotation * mean_source));
  return result;
}

}  // namespace lumibox::geometry
