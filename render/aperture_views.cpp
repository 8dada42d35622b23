#include "render/aperture_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumibox::render {
namespace {

/// Radians at S; a disc that is seen wider would go beside what anything was recorded of.
constexpr double kWidest = std::numbers::pi / 4.0;

View moved(const View& view, const Eigen::Vector2d& offset, double focus_depth) {
  config::CameraProfile c = view.camera.profile();
  c.cx += c.fx * offset.x() / focus_depth;
  c.cy += c.fy * offset.y() / focus_depth;
  const geometry::Pose& pose = view.world_from_camera;
  return {geometry::Camera(c),
          {pose.rotation, pose * Eigen::Vector3d(offset.x(), offset.y(), 0.0)}};
}

}  // namespace

double radius_of_share(double share, double exponent) {
  // The integral of (1 - r)^e r from 0 to u is, as a share of the whole,
  // 1 - (1 - u)^(e + 1) (1 + (e + 1) u).
  const double n = std::max(0.0, exponent) + 1.0;
  double low = 0.0;
  double high = 1.0;
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double u = 0.5 * (low + high);
    (1.0 - std::pow(1.0 - u, n) * (1.0 + n * u) < share ? low : high) = u;
  }
  return 0.5 * (low + high);
}

std::vector<View> aperture_views(const View& view,
                                 const std::vector<lightfield::Perspective>& perspectives,
                                 const Settings& settings) {
  const double depth = (view.world_from_camera.inverse() * settings.focus).z();
  const double limit = std::min(aperture_limit(view, perspectives, settings), kWidest);
  std::vector<View> views;
  if (!(depth > 0.0) || !std::isfinite(limit)) return views;
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < settings.aperture_views; ++i) {
    // Vogel's spiral ("A better way to construct the sunflower head", 1979).
    const double share = (i + 0.5) / settings.aperture_views;
    const double radius = depth * std::tan(limit * radius_of_share(share, settings.exponent));
    const double angle = i * golden_angle;
    views.push_back(moved(view, radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)), depth));
  }
  return views;
}

}  // namespace lumibox::render
