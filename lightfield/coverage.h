#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lightfield/perspective.h"

namespace lumibox::lightfield {

/// The dot of a perspective on the coverage map (thesis 2.3, figure 2.3): where the line from its
/// centre to S meets the sphere, on the centre's side. None for a centre at S.
std::optional<Eigen::Vector3d> dot_on_sphere(const Sphere& sphere, const Eigen::Vector3d& center);

/// Ghosting to be expected, in pixels of a camera of `focal_px`, where the view lies up to
/// `threshold` (radians, as seen from S) from the nearest perspective: e = f t r / (1 - r^2), with
/// r = sphere radius / distance of the camera to S. Infinite for r >= 1, a camera within the
/// sphere.
///
/// Where it comes from: two cameras at distance d from S, an angle t apart as seen from there, have
/// a baseline of t d, so a point at depth z is displaced in one against the other by f t d / z, and
/// a plane at depth D explains f t d / D of it; the error is f t d |1/z - 1/D|. In the sphere 1/z
/// goes from 1/(d + R) to 1/(d - R). For the plane through S, D = d, the worst errors are
/// f t r / (1 - r) of the nearest point and f t r / (1 + r) of the farthest; e is the mean of the
/// two. It is also the worst error of the plane that serves the sphere best, which has half of the
/// range of 1/z to either side, at D = d (1 - r^2).
double expected_ghosting(double focal_px, double threshold, double radius_share);

/// What is missing in the region of directions that a person covers.
struct Holes {
  /// Area of the holes in caps of the gate's angle, rounded up: at least so many perspectives are
  /// still to be taken.
  int missing = 0;
  /// Unit, in world, from S: the direction within the holes that is farthest from all recorded
  /// ones. None if there are no holes.
  std::optional<Eigen::Vector3d> largest;
};

/// Finds the holes between recorded directions, on a fixed set of directions that share the sphere
/// evenly.
///
/// The region that is covered, holes and all, follows the alpha shape of the recorded directions
/// (Edelsbrunner, Kirkpatrick and Seidel, "On the shape of a set of points in the plane", 1983),
/// alpha half of the widest gap. A direction belongs to it where no cap of that size can be put
/// over it that holds nothing recorded: so does what lies between two rows of dots, but not what is
/// beyond the first and the last one. And it belongs to it between two recorded directions whose
/// diametral cap holds no other: a gap in a single row. Both are half a gate wider. A hole is where
/// the region is farther than the gate from all that is recorded.
///
/// Gates finer than the set of directions tells (kFinest) count as that for where holes are.
class HoleFinder {
 public:
  /// Radians; the directions lie 1.6 degrees apart.
  static constexpr double kFinest = 0.055;

  HoleFinder();

  /// `directions` from S, any length, zero ones are passed over; `threshold` of the gate and
  /// `widest_gap` that still is a hole and not the end of what is covered, radians. Directions
  /// that are added to those of the call before cost little.
  Holes find(const std::vector<Eigen::Vector3d>& directions, double threshold, double widest_gap);

  /// The same in a region that stays as it is: `within` has the indices of directions().
  Holes find_within(const std::vector<std::size_t>& within,
                    const std::vector<Eigen::Vector3d>& directions, double threshold);

  /// The region that find() looks for holes in: indices of directions(), ascending.
  std::vector<std::size_t> region(const std::vector<Eigen::Vector3d>& directions, double threshold,
                                  double widest_gap);

  /// All directions: unit, in order of falling z.
  const std::vector<Eigen::Vector3d>& directions() const { return even_; }

 private:
  void see(const std::vector<Eigen::Vector3d>& directions);
  std::vector<std::size_t> region_farther_than(float nearest, double threshold,
                                               double widest_gap) const;
  Eigen::MatrixX3f middles_of_empty_caps(double reach) const;

  std::vector<Eigen::Vector3d> even_;
  std::vector<Eigen::Vector3d> seen_;      ///< the recorded directions that nearest_ is of
  std::vector<Eigen::Vector3f> recorded_;  ///< the same without zero ones, unit
  Eigen::Matrix3Xf even_columns_;
  Eigen::ArrayXf nearest_;  ///< cosine of the angle to the nearest recorded one
};

}  // namespace lumibox::lightfield
