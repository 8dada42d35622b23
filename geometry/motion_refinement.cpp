#include "geometry/motion_refinement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/levenberg_marquardt.h"

namespace lumibox::geometry {

Pose refine_motion(const Pose& start, std::span<const BearingPair> pairs,
                   const std::vector<bool>& use, int max_iterations) {
  if (std::count(use.begin(), use.end(), true) < 5) return start;
  using Row = Eigen::Matrix<double, 1, 5>;  // derivative by (rotation, direction of translation)

  const auto linearise = [&](const Pose& motion) {
    const Eigen::Matrix3d rotation = motion.matrix3();
    const Eigen::Vector3d& t = motion.translation;
    const Eigen::Matrix<double, 3, 2> tangent = tangent_basis(t);
    NormalEquations<5> sum;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (!use[i]) continue;
      // With f = R first and s = second, E first = t x f and |E^T second| = |t x s|.
      const Eigen::Vector3d f = rotation * pairs[i].first;
      const Eigen::Vector3d& s = pairs[i].second;
      const Eigen::Vector3d line_f = t.cross(f);
      const Eigen::Vector3d line_s = t.cross(s);
      const double epipolar = s.dot(line_f);
      const double slope2 = line_f.squaredNorm() + line_s.squaredNorm() - 2.0 * epipolar * epipolar;
      if (!(slope2 > 1e-30)) continue;
      const double inverse_slope = 1.0 / std::sqrt(slope2);
      const double residual = epipolar * inverse_slope;

      Row epipolar_by;  // d(s . (t x f)), with df = w x f and dt = tangent * b
      epipolar_by << f.cross(s.cross(t)).transpose(), f.cross(s).transpose() * tangent;
      Row half_slope2_by;
      half_slope2_by << f.cross(line_f.cross(t)).transpose(),
          (f.cross(line_f) + s.cross(line_s)).transpose() * tangent;
      half_slope2_by -= 2.0 * epipolar * epipolar_by;
      const Row jacobian =
          inverse_slope * epipolar_by - (residual * inverse_slope * inverse_slope) * half_slope2_by;
      sum.add<1>(Eigen::Matrix<double, 1, 1>(residual), jacobian);
    }
    return sum;
  };
  const auto retract = [](const Pose& motion, const Eigen::Matrix<double, 5, 1>& step) {
    const Eigen::Vector3d t =
        motion.translation + tangent_basis(motion.translation) * step.tail<2>();
    return Pose((exp_so3(step.head<3>()) * motion.rotation).normalized(), t.normalized());
  };
  return minimise<5>(start, linearise, retract, max_iterations);
}

}  // namespace lumibox::geometry
