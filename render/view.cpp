#include "render/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

#include "render/blending.h"
#include "render/depth_grid.h"

namespace lumibox::render {
namespace {

/// Sine of the angle between plane and line of sight below which a plane counts as edge-on.
constexpr double kEdgeOn = 1e-6;

Eigen::Vector3d optical_axis(const geometry::Pose& world_from_camera) {
  return world_from_camera.rotation * Eigen::Vector3d::UnitZ();
}

/// Thesis 3.1. The view-dependent plane is perpendicular to the view's optical axis, the
/// view-independent one to the perspective's own. The angle of projection, at which the
/// perspective would meet the view-dependent plane, is the angle between the two axes.
Eigen::Vector3d proxy_normal(const Eigen::Vector3d& view_axis, const Eigen::Vector3d& source_axis) {
  const double angle_of_projection = geometry::angle_between(view_axis, source_axis);
  const double view_independent = std::min(1.0, angle_of_projection / (0.5 * std::numbers::pi));
  return geometry::slerp(view_axis, source_axis, view_independent);
}

Eigen::Matrix3d ray_from_pixel(const config::CameraProfile& c) {
  Eigen::Matrix3d m;
  m << 1.0 / c.fx, 0.0, -c.cx / c.fx, 0.0, 1.0 / c.fy, -c.cy / c.fy, 0.0, 0.0, 1.0;
  return m;
}

/// True if the linear function f . (u, v, 1) is positive somewhere in a picture of this size; a
/// linear function is largest in a corner.
bool positive_somewhere(const Eigen::Vector3d& f, const geometry::Camera& camera) {
  const double right = camera.width() - 1.0;
  const double bottom = camera.height() - 1.0;
  const double largest = f.z() + std::max(0.0, f.x() * right) + std::max(0.0, f.y() * bottom);
  return largest > 0.0;
}

/// The layer of a perspective, weight still open; none if nothing of its plane can be seen.
std::optional<Layer> make_layer(const View& view, const lightfield::Perspective& perspective,
                                const Eigen::Vector3d& focus) {
  const Eigen::Vector3d& eye = view.world_from_camera.translation;
  const Eigen::Vector3d& source = perspective.center();
  Layer layer;
  layer.normal = proxy_normal(optical_axis(view.world_from_camera),
                              optical_axis(perspective.world_from_camera));
  // Signed distances of the plane; written so that NaN is left out too.
  const double from_view = layer.normal.dot(focus - eye);
  const double from_source = layer.normal.dot(focus - source);
  if (!(std::abs(from_view) > kEdgeOn * (focus - eye).norm())) return std::nullopt;
  if (!(std::abs(from_source) > kEdgeOn * (focus - source).norm())) return std::nullopt;

  // A ray eye + t d meets the plane n . (x - S) = 0 at 1/t = n.d / n.(S - eye). The point it meets,
  // relative to the source and divided by t, is d + (eye - source) / t: linear in d.
  const Eigen::Matrix3d ray_in_world =
      view.world_from_camera.matrix3() * ray_from_pixel(view.camera.profile());
  layer.before_view = ray_in_world.transpose() * layer.normal / from_view;
  layer.source_from_pixel = perspective.world_from_camera.matrix3().transpose() *
                            (ray_in_world + (eye - source) * layer.before_view.transpose());
  if (!layer.source_from_pixel.allFinite()) return std::nullopt;
  if (!positive_somewhere(layer.before_view, view.camera)) return std::nullopt;
  if (!positive_somewhere(layer.source_from_pixel.row(2), view.camera)) return std::nullopt;
  return layer;
}

/// The layer of a perspective before a shape, weight still open.
Layer make_turned_layer(const View& view, const lightfield::Perspective& perspective) {
  const Eigen::Matrix3d source_from_world = perspective.world_from_camera.matrix3().transpose();
  Layer layer;
  layer.normal = -optical_axis(view.world_from_camera);
  layer.source_from_pixel =
      source_from_world * view.world_from_camera.matrix3() * ray_from_pixel(view.camera.profile());
  layer.before_view = Eigen::Vector3d::UnitZ();
  layer.shift = source_from_world * (view.world_from_camera.translation - perspective.center());
  return layer;
}

/// A perspective by its penalty (figure 2.2), which is measured at the point that the planes pass
/// through: thesis 3 has one S for both.
struct Candidate {
  double penalty;
  int id;
  std::size_t index;

  bool operator<(const Candidate& other) const {
    return std::tie(penalty, id) < std::tie(other.penalty, other.id);
  }
};

std::vector<Candidate> candidates_of(const View& view,
                                     const std::vector<lightfield::Perspective>& perspectives,
                                     const Eigen::Vector3d& focus) {
  std::vector<Candidate> candidates;
  const Eigen::Vector3d towards_view = view.world_from_camera.translation - focus;
  for (std::size_t i = 0; i < perspectives.size(); ++i) {
    const lightfield::Perspective& perspective = perspectives[i];
    if (!perspective.can_be_shown()) continue;
    candidates.push_back(
        {geometry::angle_between(towards_view, perspective.center() - focus), perspective.id, i});
  }
  std::sort(candidates.begin(), candidates.end());
  return candidates;
}

/// The first `count` layers that can be seen, in order of increasing penalty.
std::vector<Layer> visible_layers(const View& view,
                                  const std::vector<lightfield::Perspective>& perspectives,
                                  const Settings& settings, std::size_t count) {
  std::vector<Layer> layers;
  for (const Candidate& candidate : candidates_of(view, perspectives, settings.focus)) {
    if (layers.size() == count) break;
    const lightfield::Perspective& perspective = perspectives[candidate.index];
    std::optional<Layer> layer = settings.shape ? make_turned_layer(view, perspective)
                                                : make_layer(view, perspective, settings.focus);
    if (!layer) continue;
    layer->perspective = candidate.index;
    layer->penalty = candidate.penalty;
    if (settings.shape && candidate.index < settings.shape->maps.size()) {
      layer->map = settings.shape->maps[candidate.index];
    }
    layers.push_back(*layer);
  }
  return layers;
}

std::vector<double> penalties_of(const std::vector<Layer>& layers) {
  std::vector<double> penalties;
  for (const Layer& layer : layers) penalties.push_back(layer.penalty);
  return penalties;
}

std::size_t most_layers(const Settings& settings) {
  return std::min(static_cast<std::size_t>(std::max(settings.k, 0)), kMaxLayers);
}

void assign_wide_weights(std::vector<Layer>& layers, std::optional<double> first_left_out,
                         double exponent) {
  const std::vector<double> penalties = penalties_of(layers);
  const double limit = first_left_out ? *first_left_out : limit_beyond(penalties);
  const std::vector<double> weights = wide_weights(penalties, limit, exponent);
  for (std::size_t i = 0; i < layers.size(); ++i) layers[i].weight = weights[i];
}

}  // namespace

double closeness(const Eigen::Vector3d& ray_of_view, const Eigen::Vector3d& ray_of_source) {
  const double view_length = ray_of_view.norm();
  const double source_length = ray_of_source.norm();
  const double angle = (ray_of_view / view_length - ray_of_source / source_length).norm();
  const double farther = std::max(0.0, source_length / view_length - 1.0);
  const double penalty = angle + kFartherPenalty * farther + kLeastPenalty;
  return 1.0 / (penalty * penalty * penalty);
}

double visibility(double seen, double inverse_depth) {
  const double hiding =
      std::clamp((seen / inverse_depth - kBefore) / (kHiding - kBefore), 0.0, 1.0);
  return 1.0 + (kHidden - 1.0) * hiding * hiding * (3.0 - 2.0 * hiding);
}

Settings settings_from(const config::Render& options, Aperture aperture,
                       const Eigen::Vector3d& focus) {
  Settings settings;
  settings.aperture = aperture;
  settings.k =
      aperture == Aperture::Small ? std::min(options.k, options.small_aperture_max_k) : options.k;
  settings.exponent = options.exponent;
  settings.focus = focus;
  settings.feather_px = options.feather_px;
  settings.small_aperture_alpha = options.small_aperture_alpha;
  settings.small_aperture_stop = options.small_aperture_stop;
  settings.aperture_views = options.aperture_views;
  return settings;
}

Settings augmented_settings_from(const config::Render& options, const Eigen::Vector3d& focus) {
  Settings settings = settings_from(options, Aperture::Wide, focus);
  settings.exponent = 0.0;
  return settings;
}

double aperture_limit(const View& view, const std::vector<lightfield::Perspective>& perspectives,
                      const Settings& settings) {
  const std::size_t k = most_layers(settings);
  const std::vector<double> penalties =
      penalties_of(visible_layers(view, perspectives, settings, k + 1));
  return penalties.size() > k ? penalties.back() : limit_beyond(penalties);
}

std::vector<Layer> plan_view(const View& view,
                             const std::vector<lightfield::Perspective>& perspectives,
                             const Settings& settings) {
  const std::size_t k = most_layers(settings);
  std::vector<Layer> layers = visible_layers(view, perspectives, settings, k + 1);
  std::optional<double> first_left_out;
  if (layers.size() > k) {
    first_left_out = layers[k].penalty;
    layers.resize(k);
  }
  if (settings.shape) {
    assign_wide_weights(layers, first_left_out, 1.0);
  } else if (settings.aperture == Aperture::Wide) {
    assign_wide_weights(layers, first_left_out, settings.exponent);
  } else {
    for (std::size_t rank = 0; rank < layers.size(); ++rank) {
      layers[rank].weight = small_alpha(rank, k, settings.small_aperture_alpha);
    }
  }
  return layers;
}

}  // namespace lumibox::render
