#include "lightfield/coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lumibox::lightfield {
namespace {

constexpr std::size_t kDirections = 16384;
/// Between neighbouring directions, radians: the side of a square of their share of the sphere.
const double kSpacing = std::sqrt(4.0 * std::numbers::pi / static_cast<double>(kDirections));

/// The Fibonacci lattice (Swinbank and Purser, "Fibonacci grids", 2006): all share the sphere
/// evenly.
std::vector<Eigen::Vector3d> fibonacci_lattice(std::size_t count) {
  std::vector<Eigen::Vector3d> directions;
  directions.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / std::numbers::phi;
    const double across = std::sqrt(1.0 - z * z);
    directions.emplace_back(across * std::cos(angle), across * std::sin(angle), z);
  }
  return directions;
}

float cosine(double angle) {
  return static_cast<float>(std::cos(angle));
}

/// The arc between two recorded directions with nothing recorded in the cap around it.
struct Bridge {
  Eigen::Vector3f middle;
  Eigen::Vector3f across;  ///< unit, perpendicular to the arc
  float half_length;       ///< cosine

  bool carries(const Eigen::Vector3f& direction, float beside) const {
    return middle.dot(direction) >= half_length && std::abs(across.dot(direction)) <= beside;
  }
};

/// Bridges longer than `from` and no longer than `to`, radians: edges of the Gabriel graph.
std::vector<Bridge> bridges_between(const std::vector<Eigen::Vector3f>& recorded, double from,
                                    double to) {
  const float longest = cosine(std::min(to, std::numbers::pi));
  const float shortest = cosine(std::min(from, std::numbers::pi));
  std::vector<Bridge> bridges;
  std::size_t in_the_way = 0;  // of the pair before: often of this one too
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const float length = recorded[i].dot(recorded[j]);
      if (length >= shortest || length < longest) continue;
      const Eigen::Vector3f middle = (recorded[i] + recorded[j]).normalized();
      const float half_length = middle.dot(recorded[i]);
      const auto blocks = [&](const Eigen::Vector3f& other) {
        return middle.dot(other) > half_length + 1e-6F;
      };
      if (blocks(recorded[in_the_way])) continue;
      const auto blocking = std::ranges::find_if(recorded, blocks);
      if (blocking != recorded.end()) {
        in_the_way = static_cast<std::size_t>(blocking - recorded.begin());
        continue;
      }
      bridges.push_back({middle, recorded[i].cross(recorded[j]).normalized(), half_length});
    }
  }
  return bridges;
}

/// Pictures that a hole of so many directions needs: its share of the sphere over that of a cap.
int caps_of(std::size_t directions, double threshold) {
  const double share = static_cast<double>(directions) / static_cast<double>(kDirections);
  const double cap = 0.5 * (1.0 - std::cos(threshold));
  return static_cast<int>(std::min(std::ceil(share / cap), 1e9));
}

}  // namespace

std::optional<Eigen::Vector3d> dot_on_sphere(const Sphere& sphere, const Eigen::Vector3d& center) {
  const Eigen::Vector3d outward = center - sphere.center;
  const double distance = outward.norm();
  if (!(distance > 0.0)) return std::nullopt;
  return sphere.center + (sphere.radius / distance) * outward;
}

double expected_ghosting(double focal_px, double threshold, double radius_share) {
  if (radius_share >= 1.0) return std::numeric_limits<double>::infinity();
  return focal_px * threshold * radius_share / (1.0 - radius_share * radius_share);
}

HoleFinder::HoleFinder() : even_(fibonacci_lattice(kDirections)), even_columns_(3, kDirections) {
  for (std::size_t i = 0; i < kDirections; ++i) {
    even_columns_.col(static_cast<Eigen::Index>(i)) = even_[i].cast<float>();
  }
}

void HoleFinder::see(const std::vector<Eigen::Vector3d>& directions) {
  const bool grown = nearest_.size() > 0 && seen_.size() <= directions.size() &&
                     std::equal(seen_.begin(), seen_.end(), directions.begin());
  const std::size_t first = grown ? seen_.size() : 0;
  if (!grown) {
    nearest_ = Eigen::ArrayXf::Constant(kDirections, -2.0F);  // farther than any
    recorded_.clear();
  }
  for (std::size_t i = first; i < directions.size(); ++i) {
    const double length = directions[i].norm();
    if (!(length > 0.0) || !std::isfinite(length)) continue;
    const Eigen::Vector3f unit = (directions[i] / length).cast<float>();
    recorded_.push_back(unit);
    nearest_ = nearest_.max((unit.transpose() * even_columns_).transpose().array());
  }
  seen_ = directions;
}

/// Of the region, what is farther from all recorded directions than `nearest`, a cosine.
std::vector<std::size_t> HoleFinder::region_farther_than(float nearest, double threshold,
                                                         double widest_gap) const {
  const double reach = std::min(0.5 * widest_gap, std::numbers::pi);
  const double half_gate = 0.5 * std::max(threshold, kFinest);
  const Eigen::MatrixX3f empty = middles_of_empty_caps(reach);
  const std::vector<Bridge> bridges = bridges_between(recorded_, 4.0 * half_gate, widest_gap);
  const float at_reach = cosine(reach);
  const float in_empty_cap = cosine(std::max(0.0, reach - half_gate));
  const auto beside = static_cast<float>(std::sin(half_gate));
  std::vector<std::size_t> region;
  for (Eigen::Index i = 0; i < nearest_.size(); ++i) {
    if (nearest_[i] < at_reach || nearest_[i] >= nearest) continue;
    const Eigen::Vector3f direction = even_columns_.col(i);
    const bool surrounded = empty.rows() == 0 || (empty * direction).maxCoeff() <= in_empty_cap;
    if (surrounded || std::ranges::any_of(bridges, [&](const Bridge& bridge) {
          return bridge.carries(direction, beside);
        })) {
      region.push_back(static_cast<std::size_t>(i));
    }
  }
  return region;
}

/// Those just beyond reach of what is recorded: they tell where all of them begin.
Eigen::MatrixX3f HoleFinder::middles_of_empty_caps(double reach) const {
  const float at_reach = cosine(reach);
  const float just_beyond = cosine(std::min(reach + 1.5 * kSpacing, std::numbers::pi));
  std::vector<Eigen::Index> middles;
  for (Eigen::Index i = 0; i < nearest_.size(); ++i) {
    if (nearest_[i] < at_reach && nearest_[i] >= just_beyond) middles.push_back(i);
  }
  return even_columns_(Eigen::all, middles).transpose();
}

std::vector<std::size_t> HoleFinder::region(const std::vector<Eigen::Vector3d>& directions,
                                            double threshold, double widest_gap) {
  see(directions);
  return region_farther_than(2.0F, threshold, widest_gap);
}

Holes HoleFinder::find_within(const std::vector<std::size_t>& within,
                              const std::vector<Eigen::Vector3d>& directions, double threshold) {
  see(directions);
  const float covered = cosine(std::max(threshold, kFinest));
  std::size_t uncovered = 0;
  std::optional<std::size_t> farthest;
  for (const std::size_t i : within) {
    const float nearest = nearest_[static_cast<Eigen::Index>(i)];
    if (nearest >= covered) continue;
    ++uncovered;
    if (!farthest || nearest < nearest_[static_cast<Eigen::Index>(*farthest)]) farthest = i;
  }
  if (!farthest) return {};
  return {caps_of(uncovered, threshold), even_[*farthest]};
}

Holes HoleFinder::find(const std::vector<Eigen::Vector3d>& directions, double threshold,
                       double widest_gap) {
  see(directions);
  const float covered = cosine(std::max(threshold, kFinest));
  return find_within(region_farther_than(covered, threshold, widest_gap), directions, threshold);
}

}  // namespace lumibox::lightfield
