#include "geometry/p3p.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumibox::geometry {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The two sides of each triangle corner: side k joins the points kSides[k].
constexpr std::array<std::array<int, 2>, 3> kSides{{{0, 1}, {0, 2}, {1, 2}}};

/// What the distances s must satisfy for each side (i, j):
///   (s_i - s_j)^2 + s_i s_j chord2 = length2,
/// the law of cosines, written so that it keeps its accuracy for narrow bundles of rays.
struct Triangle {
  Vector3d chord2;   ///< squared distances between the bearings
  Vector3d length2;  ///< squared distances between the points, the largest of them 1

  double side(int k, const Vector3d& s) const {
    const double si = s[kSides[k][0]];
    const double sj = s[kSides[k][1]];
    return (si - sj) * (si - sj) + si * sj * chord2[k];
  }
};

/// Symmetric matrix M with s^T M s = side(k, s).
Matrix3d side_form(const Triangle& triangle, int k) {
  const auto [i, j] = kSides[k];
  Matrix3d form = Matrix3d::Zero();
  form(i, i) = form(j, j) = 1.0;
  form(i, j) = form(j, i) = 0.5 * triangle.chord2[k] - 1.0;
  return form;
}

Matrix3d cofactors(const Matrix3d& m) {
  Matrix3d c;
  c.col(0) = m.col(1).cross(m.col(2));
  c.col(1) = m.col(2).cross(m.col(0));
  c.col(2) = m.col(0).cross(m.col(1));
  return c;
}

/// The real root of x^3 + a x^2 + b x + c that lies farthest from the others (Cardano, Viete), two
/// Newton steps to full accuracy.
double separate_cubic_root(double a, double b, double c) {
  const double shift = a / 3.0;
  const double p = b - a * shift;  // depressed: t^3 + p t + q with x = t - shift
  const double q = c - shift * (b - 2.0 * shift * shift);
  const double discriminant = 0.25 * q * q + p * p * p / 27.0;
  double t = 0.0;
  if (discriminant > 0.0) {
    const double u = std::cbrt(-0.5 * q - std::copysign(std::sqrt(discriminant), q));
    t = u == 0.0 ? 0.0 : u - p / (3.0 * u);
  } else {
    const double radius = std::sqrt(-p / 3.0);
    const double sine = std::sqrt(-discriminant);
    const double angle = std::atan2(sine, 0.5 * std::abs(q)) / 3.0;
    t = -std::copysign(2.0 * radius * std::cos(angle), q);
  }
  double x = t - shift;
  for (int i = 0; i < 2; ++i) {
    const double slope = (3.0 * x + 2.0 * a) * x + b;
    if (slope == 0.0) break;
    x -= (((x + a) * x + b) * x + c) / slope;
  }
  return x;
}

struct ConicPair {
  Matrix3d degenerate;  ///< a member of the pencil with determinant zero: two lines
  Matrix3d other;       ///< another member
};

ConicPair degenerate_member(Matrix3d d1, Matrix3d d2) {
  d1 /= d1.norm();
  d2 /= d2.norm();
  Matrix3d cofactors1 = cofactors(d1);
  Matrix3d cofactors2 = cofactors(d2);
  double determinant1 = d1.col(0).dot(cofactors1.col(0));
  double determinant2 = d2.col(0).dot(cofactors2.col(0));
  if (std::abs(determinant2) < std::abs(determinant1)) {
    std::swap(d1, d2);
    std::swap(cofactors1, cofactors2);
    std::swap(determinant1, determinant2);
  }
  if (determinant2 == 0.0) return {d1, d2};
  const double root = separate_cubic_root(cofactors2.cwiseProduct(d1).sum() / determinant2,
                                          cofactors1.cwiseProduct(d2).sum() / determinant2,
                                          determinant1 / determinant2);
  return {d1 + root * d2, std::abs(root) < 1.0 ? d2 : d1};
}

/// Where a line through `p` and `q` (homogeneous) meets the conic; appends up to two points.
void intersect_line(const Matrix3d& conic, const Vector3d& p, const Vector3d& q,
                    std::vector<Vector3d>* points) {
  const double a = p.dot(conic * p);
  const double b = p.dot(conic * q);
  const double c = q.dot(conic * q);
  const double discriminant = b * b - a * c;
  // Where both intersections fall together, rounding may make them just miss.
  if (discriminant < -1e-8 * (b * b + std::abs(a * c))) return;
  const double sum = b + std::copysign(std::sqrt(std::max(discriminant, 0.0)), b);
  points->push_back(-sum * p + a * q);
  points->push_back(c * p - sum * q);
}

std::vector<Vector3d> intersect_conics(const Matrix3d& d1, const Matrix3d& d2) {
  const ConicPair pair = degenerate_member(d1, d2);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(pair.degenerate);
  const Vector3d common = eigen.eigenvectors().col(1);  // the point where the two lines meet
  const Vector3d high =
      std::sqrt(std::max(eigen.eigenvalues()[2], 0.0)) * eigen.eigenvectors().col(2);
  const Vector3d low =
      std::sqrt(std::max(-eigen.eigenvalues()[0], 0.0)) * eigen.eigenvectors().col(0);
  std::vector<Vector3d> points;
  points.reserve(4);
  intersect_line(pair.other, common, common.cross(high + low), &points);
  intersect_line(pair.other, common, common.cross(high - low), &points);
  return points;
}

/// Scales homogeneous distances to the triangle's size and sharpens them by Newton's method; false
/// if they are not positive.
bool polish(const Triangle& triangle, Vector3d* s) {
  if (s->sum() < 0.0) *s = -*s;
  if (!(s->minCoeff() > 0.0)) return false;
  double size2 = 0.0;
  for (int k = 0; k < 3; ++k) size2 += triangle.side(k, *s);
  if (!(size2 > 0.0)) return false;
  *s *= std::sqrt(triangle.length2.sum() / size2);
  for (int iteration = 0; iteration < 6; ++iteration) {
    Vector3d error;
    Matrix3d jacobian = Matrix3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const auto [i, j] = kSides[k];
      const double si = (*s)[i];
      const double sj = (*s)[j];
      error[k] = triangle.side(k, *s) - triangle.length2[k];
      jacobian(k, i) = 2.0 * (si - sj) + sj * triangle.chord2[k];
      jacobian(k, j) = 2.0 * (sj - si) + si * triangle.chord2[k];
    }
    Matrix3d inverse;
    bool invertible = false;
    jacobian.computeInverseWithCheck(inverse, invertible, 1e-30);
    if (!invertible) break;
    const Vector3d step = inverse * error;
    if (!(step.norm() < 0.5 * s->norm())) break;
    *s -= step;
    if (step.norm() < 1e-15 * s->norm()) break;
  }
  return s->minCoeff() > 0.0;
}

/// Right-handed orthonormal frame of a triangle, as columns.
Matrix3d frame_of(const std::array<Vector3d, 3>& corner) {
  Matrix3d frame;
  frame.col(0) = (corner[1] - corner[0]).normalized();
  frame.col(2) = frame.col(0).cross(corner[2] - corner[0]).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

bool is_collinear(const std::array<Vector3d, 3>& corner, double longest2) {
  const double twice_area = (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
  return !(twice_area > 1e-9 * longest2);
}

}  // namespace

std::vector<Pose> solve_p3p(const std::array<Vector3d, 3>& points_in_world,
                            const std::array<Vector3d, 3>& bearings) {
  Triangle triangle;
  for (int k = 0; k < 3; ++k) {
    const auto [i, j] = kSides[k];
    triangle.length2[k] = (points_in_world[i] - points_in_world[j]).squaredNorm();
    triangle.chord2[k] = (bearings[i] - bearings[j]).squaredNorm();
  }
  const double longest2 = triangle.length2.maxCoeff();
  if (!(longest2 > 0.0) || is_collinear(points_in_world, longest2)) return {};
  if (!(triangle.chord2.minCoeff() > 1e-20)) return {};
  triangle.length2 /= longest2;

  const Matrix3d m01 = side_form(triangle, 0);
  const Matrix3d m02 = side_form(triangle, 1);
  const Matrix3d m12 = side_form(triangle, 2);
  const Vector3d& a = triangle.length2;
  std::vector<Pose> poses;
  for (Vector3d& s : intersect_conics(m01 * a[2] - m12 * a[0], m02 * a[2] - m12 * a[1])) {
    if (!polish(triangle, &s)) continue;
    s *= std::sqrt(longest2);
    const std::array<Vector3d, 3> in_camera{s[0] * bearings[0], s[1] * bearings[1],
                                            s[2] * bearings[2]};
    if (is_collinear(in_camera, longest2)) continue;
    const Matrix3d rotation = frame_of(in_camera) * frame_of(points_in_world).transpose();
    Pose pose(rotation, Vector3d::Zero());
    for (int i = 0; i < 3; ++i) {
      pose.translation += (in_camera[i] - pose.rotation * points_in_world[i]) / 3.0;
    }
    const bool seen = std::ranges::all_of(std::array{0, 1, 2}, [&](int i) {
      return angle_between(pose * points_in_world[i], bearings[i]) < 1e-6;
    });
    if (seen) poses.push_back(pose);
  }
  return poses;
}

}  // namespace lumibox::geometry
