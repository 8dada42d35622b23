#include "lightfield/epipolar_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "geometry/rotation.h"

namespace lumibox::lightfield {
namespace {

constexpr double kMinSine = 0.05;      // of the angle from the epipole
constexpr double kMaxParallax = 0.8;   // radians: beyond it nothing looks alike
constexpr int kMaxDistance2 = 90000;   // of descriptors: 300 of at most 724
constexpr double kRatio2 = 0.8 * 0.8;  // Lowe's, squared
constexpr double kSamePlace = 2.0;     // tolerances: so near, the second best is the same thing

/// A feature as seen from the baseline: rays that meet have one azimuth around it, and the second
/// camera's is at the larger angle from it.
struct Ray {
  double azimuth = 0.0;  ///< (-pi, pi]
  double angle = 0.0;    ///< from the direction of camera a to camera b, radians
  double sine = 0.0;     ///< of the angle
  std::size_t feature = 0;
};

/// The rays by ascending azimuth; those near the epipoles are left out.
std::vector<Ray> rays_around(const Eigen::Vector3d& baseline, const Features& features,
                             const geometry::Pose& world_from_camera) {
  const Eigen::Matrix<double, 3, 2> across = geometry::tangent_basis(baseline);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < features.bearings.size(); ++i) {
    const Eigen::Vector3d ray = world_from_camera.rotation * features.bearings[i];
    const Eigen::Vector2d off = across.transpose() * ray;
    const double sine = off.norm();
    if (sine < kMinSine) continue;
    rays.push_back({std::atan2(off.y(), off.x()), std::atan2(sine, baseline.dot(ray)), sine, i});
  }
  std::sort(rays.begin(), rays.end(), [](const Ray& a, const Ray& b) {
    return std::pair(a.azimuth, a.feature) < std::pair(b.azimuth, b.feature);
  });
  return rays;
}

int distance2(const Descriptor& a, const Descriptor& b) {
  int sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const int difference = a[i] - b[i];
    sum += difference * difference;
  }
  return sum;
}

/// One of the two pictures.
struct Side {
  const Features& features;
  std::vector<Ray> rays;
};

/// Finds in one picture what may be a ray of the other.
class Search {
 public:
  /// `sense` is 1 if `in` is camera b, -1 if it is camera a.
  Search(const Side& from, const Side& in, double sense) : from_(from), in_(in), sense_(sense) {
    tolerance_ = std::max(from.features.tolerance_rad, in.features.tolerance_rad);
  }

  /// The feature most like a ray's, if none elsewhere on its line is nearly as much so: neither in
  /// the other picture nor in its own, which may show a repetition that the other cuts off.
  std::optional<std::size_t> best(const Ray& ray) {
    collect(ray, in_, -tolerance_, kMaxParallax);
    const auto nearest = std::min_element(candidates_.begin(), candidates_.end());
    if (nearest == candidates_.end() || nearest->first > kMaxDistance2) return std::nullopt;
    const auto [distance, feature] = *nearest;
    if (!stands_out(distance, feature, in_.features)) return std::nullopt;
    collect(ray, from_, -kMaxParallax, kMaxParallax);
    if (!stands_out(distance, ray.feature, from_.features)) return std::nullopt;
    return feature;
  }

 private:
  /// Makes the candidates those of one picture that are on a ray's line in a range of parallax.
  void collect(const Ray& ray, const Side& side, double lowest, double highest) {
    candidates_.clear();
    // The line goes on beyond the end of the azimuths.
    for (const double turn : {-2.0 * std::numbers::pi, 0.0, 2.0 * std::numbers::pi}) {
      const double azimuth = ray.azimuth + turn;
      const double width = 2.0 * tolerance_ / ray.sine;
      auto other = std::lower_bound(side.rays.begin(), side.rays.end(), azimuth - width,
                                    [](const Ray& r, double limit) { return r.azimuth < limit; });
      for (; other != side.rays.end() && other->azimuth <= azimuth + width; ++other) {
        const double off = std::abs(other->azimuth - azimuth) * std::min(ray.sine, other->sine);
        const double parallax = sense_ * (other->angle - ray.angle);
        if (off > tolerance_ || parallax < lowest || parallax > highest) continue;
        candidates_.emplace_back(distance2(from_.features.descriptors[ray.feature],
                                           side.features.descriptors[other->feature]),
                                 other->feature);
      }
    }
  }

  /// Lowe's test of a feature at a distance against the candidates that are not at its place.
  bool stands_out(int distance, std::size_t feature, const Features& features) const {
    const double same_px = kSamePlace * features.tolerance_px;
    return std::none_of(candidates_.begin(), candidates_.end(), [&](const auto& other) {
      return distance >= kRatio2 * other.first &&
             (features.pixels[other.second] - features.pixels[feature]).norm() > same_px;
    });
  }

  const Side& from_;
  const Side& in_;
  double sense_;
  double tolerance_ = 0.0;
  std::vector<std::pair<int, std::size_t>> candidates_;  ///< distance and feature
};

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// Of every feature of `from` the best in `in`, or kNone.
std::vector<std::size_t> best_of_all(const Side& from, const Side& in, double sense) {
  Search search(from, in, sense);
  std::vector<std::size_t> best(from.features.bearings.size(), kNone);
  for (const Ray& ray : from.rays) best[ray.feature] = search.best(ray).value_or(kNone);
  return best;
}

}  // namespace

std::vector<Match> match_along_epipolar_lines(const Features& a, const geometry::Pose& world_from_a,
                                              const Features& b,
                                              const geometry::Pose& world_from_b) {
  const Eigen::Vector3d baseline = world_from_b.translation - world_from_a.translation;
  if (!(baseline.norm() > 0.0)) return {};
  const Side side_a{a, rays_around(baseline.normalized(), a, world_from_a)};
  const Side side_b{b, rays_around(baseline.normalized(), b, world_from_b)};
  const auto in_b = best_of_all(side_a, side_b, 1.0);
  const auto in_a = best_of_all(side_b, side_a, -1.0);
  std::vector<Match> matches;
  for (std::size_t i = 0; i < in_b.size(); ++i) {
    if (in_b[i] != kNone && in_a[in_b[i]] == i) matches.emplace_back(i, in_b[i]);
  }
  return matches;
}

}  // namespace lumibox::lightfield
