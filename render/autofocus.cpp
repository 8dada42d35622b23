#include "render/autofocus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "geometry/robust.h"
#include "render/reduced.h"
#include "render/sampling.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

constexpr int kMaxPixels = 80000;       // of a picture; 640x480 becomes 320x240
constexpr std::size_t kPictures = 6;    // more cost more than they tell
constexpr double kWindow = 0.08;        // width and height, of the view's width
constexpr int kAcross = 13;             // rays across the window
constexpr int kSteps = 60;              // of kFocusStep: up to three times as near as the focus
constexpr double kLeastSeen = 0.5;      // share of the window that must be compared
constexpr double kLeastDetail = 4.0;    // grey levels squared: a camera's noise has as much
constexpr double kMostRemaining = 0.5;  // of the usual disagreement, where the pictures agree
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Source {
  Perspective perspective;  // reduced
  geometry::Pose camera_from_world;
  std::shared_ptr<const hal::Image> pixels;
};

/// The pictures nearest to the view among those that the wide aperture blends.
std::vector<Source> sources_of(const View& view, const std::vector<Perspective>& perspectives,
                               Settings settings) {
  settings.aperture = Aperture::Wide;
  settings.shape = nullptr;
  std::vector<Source> sources;
  for (const Layer& layer : plan_view(view, perspectives, settings)) {
    if (sources.size() == kPictures) break;
    auto small = reduced(perspectives[layer.perspective], kMaxPixels);
    if (!small) continue;  // lost
    auto pixels = small->photo->rgb();
    if (!pixels) continue;
    const geometry::Pose camera_from_world = small->world_from_camera.inverse();
    sources.push_back({std::move(*small), camera_from_world, std::move(pixels)});
  }
  return sources;
}

/// Rays through the window, in the camera's frame, z = 1.
std::vector<Eigen::Vector3d> rays_of_window(const geometry::Camera& camera) {
  const geometry::Camera pinhole = camera.undistorted();
  const double half = 0.5 * kWindow * pinhole.width();
  std::vector<Eigen::Vector3d> rays;
  for (int row = 0; row < kAcross; ++row) {
    for (int column = 0; column < kAcross; ++column) {
      const Eigen::Vector2d pixel(
          0.5 * (pinhole.width() - 1) + half * (2.0 * column / (kAcross - 1) - 1.0),
          0.5 * (pinhole.height() - 1) + half * (2.0 * row / (kAcross - 1) - 1.0));
      const auto ray = pinhole.unproject(pixel);
      if (ray) rays.push_back(ray->homogeneous());
    }
  }
  return rays;
}

/// What a picture shows at points in world, less its mean there, so that exposure and shading do
/// not count. None where it does not see the point.
std::vector<std::optional<Eigen::Vector3d>> details(const Source& source,
                                                    const std::vector<Eigen::Vector3d>& points) {
  std::vector<std::optional<Eigen::Vector3d>> colors;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  const geometry::Camera& camera = *source.perspective.camera;
  for (const Eigen::Vector3d& point : points) {
    const auto pixel = camera.project(source.camera_from_world * point);
    if (!pixel || !camera.contains(*pixel)) {
      colors.emplace_back();
      continue;
    }
    colors.emplace_back(sample_bilinear(*source.pixels, *pixel));
    sum += *colors.back();
    count += 1.0;
  }
  for (auto& color : colors) {
    if (color) *color -= sum / count;
  }
  return colors;
}

/// How much the pictures differ if what the window shows lies at a depth: variance between them,
/// grey levels squared, mean over the window. Infinite if too little can be compared.
double disagreement(const View& view, const std::vector<Source>& sources,
                    const std::vector<Eigen::Vector3d>& rays, double depth) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& ray : rays) points.push_back(view.world_from_camera * (depth * ray));
  std::vector<std::vector<std::optional<Eigen::Vector3d>>> seen;
  for (const Source& source : sources) seen.push_back(details(source, points));
  double variances = 0.0;
  double compared = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double squares = 0.0;
    double count = 0.0;
    for (const auto& colors : seen) {
      if (!colors[i]) continue;
      sum += *colors[i];
      squares += colors[i]->squaredNorm();
      count += 1.0;
    }
    if (count < 2.0) continue;
    variances += (squares - sum.squaredNorm() / count) / (3.0 * (count - 1.0));
    compared += 1.0;
  }
  return compared >= kLeastSeen * static_cast<double>(points.size()) ? variances / compared
                                                                     : kInfinity;
}

/// Index of the least value to a fraction, by the parabola through it and its neighbours; none if
/// it is no valley, or hardly lower than most.
std::optional<double> valley(const std::vector<double>& values) {
  std::vector<double> told;
  for (const double value : values) {
    if (std::isfinite(value)) told.push_back(value);
  }
  const auto least = std::ranges::min_element(values);
  if (told.size() < 3 || least == values.begin() || least + 1 == values.end()) return std::nullopt;
  const double usual = geometry::median(std::move(told));
  if (usual < kLeastDetail || *least > kMostRemaining * usual) return std::nullopt;
  return static_cast<double>(least - values.begin()) +
         valley_offset(*(least - 1), *least, *(least + 1));
}

}  // namespace

std::optional<double> autofocus(const View& view, const std::vector<Perspective>& perspectives,
                                const Settings& settings) {
  const double depth = (view.world_from_camera.inverse() * settings.focus).z();
  if (!(depth > 0.0) || !std::isfinite(depth)) return std::nullopt;
  const std::vector<Source> sources = sources_of(view, perspectives, settings);
  if (sources.size() < 2) return std::nullopt;
  const std::vector<Eigen::Vector3d> rays = rays_of_window(view.camera);
  std::vector<double> curve;
  for (int step = 1; step <= kSteps; ++step) {
    curve.push_back(disagreement(view, sources, rays, depth / (kFocusStep * step)));
  }
  const auto index = valley(curve);
  if (!index) return std::nullopt;
  return depth / (kFocusStep * (*index + 1.0));
}

}  // namespace lumibox::render
