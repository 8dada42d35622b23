#include "lightfield/neighbours.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "geometry/robust.h"
#include "geometry/rotation.h"

namespace lumibox::lightfield {
namespace {

constexpr double kMaxAngle = std::numbers::pi / 3.0;    // between optical axes
constexpr double kUnitAngle = std::numbers::pi / 18.0;  // counts as the typical distance does
// Of the others in order of nearness, which are taken: farther ones for parallax.
constexpr std::array<std::size_t, 8> kRanks{0, 1, 2, 3, 5, 7, 11, 15};

Eigen::Vector3d optical_axis(const Perspective& perspective) {
  return perspective.world_from_camera.rotation * Eigen::Vector3d::UnitZ();
}

/// Median distance from a perspective to the nearest one at another place; 0 if there is none.
double typical_distance(const std::vector<Perspective>& perspectives) {
  std::vector<double> nearest;
  for (const Perspective& a : perspectives) {
    double least = 0.0;
    for (const Perspective& b : perspectives) {
      const double distance = (a.center() - b.center()).norm();
      if (distance > 0.0 && (least == 0.0 || distance < least)) least = distance;
    }
    if (least > 0.0) nearest.push_back(least);
  }
  return geometry::median(std::move(nearest));
}

/// The others that may see what perspective `of` sees, the nearest first.
std::vector<std::size_t> by_nearness(const std::vector<Perspective>& perspectives, std::size_t of,
                                     double unit_distance) {
  std::vector<std::pair<double, std::size_t>> others;
  for (std::size_t i = 0; i < perspectives.size(); ++i) {
    const double distance = (perspectives[i].center() - perspectives[of].center()).norm();
    const double angle =
        geometry::angle_between(optical_axis(perspectives[i]), optical_axis(perspectives[of]));
    if (!(distance > 0.0) || angle > kMaxAngle) continue;
    others.emplace_back(std::hypot(distance / unit_distance, angle / kUnitAngle), i);
  }
  std::sort(others.begin(), others.end());
  std::vector<std::size_t> indices;
  for (const auto& [nearness, i] : others) indices.push_back(i);
  return indices;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> neighbouring_pairs(
    const std::vector<Perspective>& perspectives) {
  const double unit_distance = typical_distance(perspectives);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < perspectives.size(); ++i) {
    const std::vector<std::size_t> others = by_nearness(perspectives, i, unit_distance);
    for (const std::size_t rank : kRanks) {
      if (rank < others.size()) pairs.push_back(std::minmax(i, others[rank]));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace lumibox::lightfield
