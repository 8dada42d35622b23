#include "tracking/third_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/absolute_pose.h"
#include "geometry/robust.h"
#include "geometry/rotation.h"
#include "geometry/triangulation.h"

namespace lumibox::tracking {
namespace {

constexpr double kClearRatio = 0.7;  // of the best candidate's error to the next one's
constexpr double kMinShare = 0.6;    // of the points that must lie before both cameras

/// Median angle between where the points of one shape should be seen and where they are, over the
/// views between; infinite if the motion puts too many points behind a camera.
double misfit(const geometry::Pose& second_from_first, const ManyViews& views) {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < views.first.size(); ++i) {
    const auto point =
        geometry::triangulate(geometry::Pose(), second_from_first, views.first[i], views.second[i]);
    if (!point) continue;
    points.push_back(*point);
    index.push_back(i);
  }
  if (static_cast<double>(points.size()) < kMinShare * static_cast<double>(views.first.size())) {
    return std::numeric_limits<double>::infinity();
  }
  std::vector<double> errors;
  const std::vector<bool> all(points.size(), true);
  for (std::size_t v = 0; v < views.between.size(); ++v) {
    const double share = static_cast<double>(v + 1) / static_cast<double>(views.between.size() + 1);
    const geometry::Pose start = geometry::exp_se3(share * geometry::log_se3(second_from_first));
    std::vector<Eigen::Vector3d> bearings;
    for (const std::size_t i : index) bearings.push_back(views.between[v][i]);
    const geometry::Pose pose = geometry::refine_absolute_pose(start, points, bearings, all);
    for (std::size_t i = 0; i < points.size(); ++i) {
      errors.push_back(geometry::angle_between(pose * points[i], bearings[i]));
    }
  }
  if (errors.empty()) return std::numeric_limits<double>::infinity();
  return geometry::median(std::move(errors));
}

}  // namespace

std::optional<std::size_t> decide_by_third_view(
    std::span<const geometry::Pose> candidates_second_from_first, const ManyViews& views,
    double noise_rad) {
  std::size_t best = 0;
  double best_misfit = std::numeric_limits<double>::infinity();
  double next_misfit = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < candidates_second_from_first.size(); ++i) {
    const double error = misfit(candidates_second_from_first[i], views);
    if (error < best_misfit) {
      next_misfit = best_misfit;
      best_misfit = error;
      best = i;
    } else {
      next_misfit = std::min(next_misfit, error);
    }
  }
  if (!(best_misfit < noise_rad) || !(best_misfit < kClearRatio * next_misfit)) return std::nullopt;
  return best;
}

}  // namespace lumibox::tracking
