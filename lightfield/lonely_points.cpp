#include "lightfield/lonely_points.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace lumibox::lightfield {
namespace {

constexpr std::size_t kSureViews = 6;   // so many do not meet by chance
constexpr std::size_t kNeighbours = 8;  // nearest in the picture
constexpr int kSupport = 2;             // of them must be as far away
constexpr double kDepthShare = 0.1;     // to this

/// A point as a view sees it.
struct Sighting {
  Eigen::Vector2d pixel;
  double depth = 0.0;
  std::size_t point = 0;
};

std::vector<std::vector<Sighting>> sightings_by_view(std::span<const View> views,
                                                     const std::vector<TrackPoint>& points) {
  std::vector<std::vector<Sighting>> sightings(views.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const std::size_t v : points[i].views) {
      const Eigen::Vector3d in_camera = views[v].camera_from_world * points[i].position;
      const auto pixel = views[v].camera->project(in_camera);
      if (pixel) sightings[v].push_back({*pixel, in_camera.z(), i});
    }
  }
  return sightings;
}

/// True if others around it are at its depth.
bool is_supported(const Sighting& sighting, const std::vector<Sighting>& all,
                  std::vector<std::pair<double, double>>& nearest) {
  nearest.clear();  // squared distance in the picture, and depth
  for (const Sighting& other : all) {
    if (other.point == sighting.point) continue;
    nearest.emplace_back((other.pixel - sighting.pixel).squaredNorm(), other.depth);
  }
  const std::size_t count = std::min(kNeighbours, nearest.size());
  std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count),
                    nearest.end());
  int alike = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (std::abs(nearest[i].second - sighting.depth) < kDepthShare * sighting.depth) ++alike;
  }
  return alike >= kSupport;
}

}  // namespace

std::vector<TrackPoint> without_lonely_points(std::span<const View> views,
                                              const std::vector<TrackPoint>& points) {
  std::vector<std::size_t> supported(points.size(), 0);
  std::vector<std::pair<double, double>> nearest;
  for (const std::vector<Sighting>& all : sightings_by_view(views, points)) {
    for (const Sighting& sighting : all) {
      if (points[sighting.point].views.size() >= kSureViews) continue;
      if (is_supported(sighting, all, nearest)) ++supported[sighting.point];
    }
  }
  std::vector<TrackPoint> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t seen = points[i].views.size();
    if (seen >= kSureViews || 2 * supported[i] > seen) kept.push_back(points[i]);
  }
  return kept;
}

}  // namespace lumibox::lightfield
