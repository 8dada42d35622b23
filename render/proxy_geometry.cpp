#include "render/proxy_geometry.h"

#include <algorithm>
#include <utility>

#include "geometry/robust.h"
#include "render/blending.h"
#include "render/depth_grid.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

constexpr std::size_t kMapsOfView = 4;  // more blur the shape
constexpr std::size_t kMinPoints = 20;
constexpr double kStray = 0.02;  // share of points that may be wrong, at either end

}  // namespace

Geometry geometry_named(const std::string& name) {
  if (name == "focal") return Geometry::Focal;
  return name == "mesh" ? Geometry::Mesh : Geometry::Plane;
}

ProxyGeometry::ProxyGeometry(std::vector<Eigen::Vector3d> points, Estimating estimating)
    : points_(std::move(points)), maps_(estimating) {}

Settings ProxyGeometry::fit(Settings settings, Geometry geometry, const View& view,
                            const std::vector<Perspective>& perspectives,
                            const std::optional<std::vector<std::size_t>>& counted) {
  if (geometry == Geometry::Focal) {
    settings.focus = focal_point(view, settings.focus);
  } else if (geometry == Geometry::Mesh) {
    settings.shape = shape_of(view, perspectives, settings.focus, counted);
    if (settings.shape) settings.k = std::min(settings.k, static_cast<int>(kPicturesOfView));
  }
  return settings;
}

Eigen::Vector3d ProxyGeometry::focal_point(const View& view,
                                           const Eigen::Vector3d& otherwise) const {
  const geometry::Pose camera_from_world = view.world_from_camera.inverse();
  std::vector<double> inverse_depths;
  for (const Eigen::Vector3d& point : points_) {
    const Eigen::Vector3d seen = camera_from_world * point;
    const auto pixel = view.camera.project(seen);
    if (pixel && view.camera.contains(*pixel)) inverse_depths.push_back(1.0 / seen.z());
  }
  if (inverse_depths.size() < kMinPoints) return otherwise;
  const double farthest = geometry::quantile(inverse_depths, kStray);
  const double nearest = geometry::quantile(std::move(inverse_depths), 1.0 - kStray);
  return view.world_from_camera * Eigen::Vector3d(0.0, 0.0, 2.0 / (farthest + nearest));
}

std::shared_ptr<const Shape> ProxyGeometry::shape_of(
    const View& view, const std::vector<Perspective>& perspectives, const Eigen::Vector3d& focus,
    const std::optional<std::vector<std::size_t>>& counted) {
  auto ranked = nearest_by_angle(perspectives, view.world_from_camera.translation, focus);
  if (counted) {
    std::erase_if(ranked, [&](const auto& candidate) {
      return std::ranges::find(*counted, candidate.second) == counted->end();
    });
  }
  const std::size_t count = std::min(kMapsOfView, ranked.size());
  std::vector<double> penalties;
  for (std::size_t i = 0; i < count; ++i) penalties.push_back(ranked[i].first);
  const double limit = count < ranked.size() ? ranked[count].first : limit_beyond(penalties);
  const std::vector<double> weights = wide_weights(penalties, limit, 1.0);
  std::vector<DepthGrid::Source> sources;
  std::vector<std::shared_ptr<const DepthMap>> maps(perspectives.size());
  // The nearest last: what is asked for last is made first.
  for (std::size_t i = std::min<std::size_t>(kPicturesOfView, ranked.size()); i-- > 0;) {
    const std::size_t index = ranked[i].second;
    maps[index] = maps_.map_of(perspectives, index, focus);
    if (i < count && weights[i] > 0.0 && maps[index]) {
      sources.push_back({maps[index], perspectives[index].world_from_camera, weights[i]});
    }
  }
  if (sources.empty()) return nullptr;
  const Eigen::Vector3d eye = view.world_from_camera.translation;
  const double fallback = 1.0 / std::max((focus - eye).norm(), 1e-9);
  return std::make_shared<Shape>(DepthGrid(view, sources, fallback), std::move(maps));
}

}  // namespace lumibox::render
