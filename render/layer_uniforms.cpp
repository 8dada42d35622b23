#include "render/layer_uniforms.h"

#include <algorithm>
#include <limits>

#include "render/blending.h"
#include "render/depth_grid.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

std::array<float, 4> vec4(const Eigen::Vector3d& v, double w) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()),
          static_cast<float>(w)};
}

/// Pixel of the view (first centre at 0, rows down) from a place as the shader has it (from the
/// view's middle, rows up).
Eigen::Matrix3d pixel_from_place(const View& view) {
  Eigen::Matrix3d m;
  m << 1.0, 0.0, 0.5 * (view.camera.width() - 1), 0.0, -1.0, 0.5 * (view.camera.height() - 1), 0.0,
      0.0, 1.0;
  return m;
}

/// True if the linear function f . (x, y, 1) is positive everywhere in a view.
bool positive_everywhere(const Eigen::Vector3d& f, const View& view) {
  const Eigen::Vector2d middle = middle_of(view);
  return f.z() - std::abs(f.x()) * middle.x() - std::abs(f.y()) * middle.y() > 0.0;
}

/// A layer's geometry in the shader's places and lengths.
struct Places {
  Eigen::Matrix3d source;
  Eigen::Vector3d beyond;

  Places(const View& view, const Layer& layer, const Perspective& perspective, const Kind& kind,
         double largest_map, double unit) {
    source = layer.source_from_pixel * pixel_from_place(view);
    if (kind.shape) {
      // Any scale will do: the one in which the map's samples are as the texture has them.
      source *= largest_map * unit;
      beyond = layer.shift * largest_map;
      return;
    }
    if (!kind.distortion) source = perspective.camera->pinhole_matrix() * source;
    beyond = pixel_from_place(view).transpose() * layer.before_view;
  }

  bool may_lie_behind(const View& view, double largest_inverse_depth, bool shape) const {
    const Eigen::Vector3d z = source.row(2);
    if (!positive_everywhere(z, view)) return true;
    if (!shape) return !positive_everywhere(beyond, view);
    const Eigen::Vector3d nearest =
        z + largest_inverse_depth * beyond.z() * Eigen::Vector3d::UnitZ();
    return !positive_everywhere(nearest, view);
  }
};

void set_camera(LayerUniforms& u, const Perspective& perspective, const Layer& layer,
                const Settings& settings) {
  const config::CameraProfile& c = perspective.camera->profile();
  const double fold = std::min(perspective.camera->fold_radius2(),
                               static_cast<double>(std::numeric_limits<float>::max()));
  const bool fisheye = c.model == config::LensModel::Fisheye;
  const double feather = feather_width(c.width, c.height, settings.feather_px);
  const double map_scale = layer.map ? layer.map->camera.profile().fx / c.fx : 0.0;
  u.picture = vec4({c.width - 1.0, c.height - 1.0, 1.0 / feather}, map_scale);
  u.intrinsics = vec4({c.fx, c.fy, c.cx}, c.cy);
  u.distortion = fisheye ? vec4({c.k1, c.k2, c.k3}, c.k4) : vec4({c.k1, c.k2, c.p1}, c.p2);
  u.lens = vec4({c.k3, fold, fisheye ? 1.0 : 0.0}, 0.0);
}

/// A layer that has no map yet does not make its camera another one.
void share_map_scale(std::vector<LayerUniforms>& layers) {
  float scale = 0.0F;
  for (const LayerUniforms& u : layers) scale = std::max(scale, u.picture[3]);
  for (LayerUniforms& u : layers) {
    if (u.picture[3] == 0.0F) u.picture[3] = scale;
  }
}

}  // namespace

bool LayerUniforms::same_camera(const LayerUniforms& other) const {
  return picture == other.picture && intrinsics == other.intrinsics &&
         distortion == other.distortion && lens == other.lens;
}

Eigen::Vector2d middle_of(const View& view) {
  return {0.5 * view.camera.width(), 0.5 * view.camera.height()};
}

double unit_of(const View& view, const Settings& settings) {
  const double distance = (settings.focus - view.world_from_camera.translation).norm();
  return distance > 0.0 ? distance : 1.0;
}

LayerData layer_data(const View& view, const std::vector<Perspective>& perspectives,
                     const Settings& settings, const std::vector<Layer>& layers,
                     const std::vector<LayerSlots>& slots) {
  LayerData data;
  Kind& kind = data.kind;
  kind.shape = settings.shape != nullptr;
  kind.small_aperture = settings.aperture == Aperture::Small && !kind.shape;
  kind.distortion = std::any_of(layers.begin(), layers.end(), [&](const Layer& layer) {
    return perspectives[layer.perspective].camera->has_distortion();
  });
  const double unit = unit_of(view, settings);
  const double largest = kind.shape ? unit * settings.shape->grid.largest() : 0.0;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Layer& layer = layers[i];
    const Perspective& perspective = perspectives[layer.perspective];
    const Places places(view, layer, perspective, kind, slots[i].largest_map, unit);
    kind.horizon = kind.horizon || places.may_lie_behind(view, largest, kind.shape);
    LayerUniforms u;
    u.from_x = vec4(places.source.col(0), slots[i].picture);
    u.from_y = vec4(places.source.col(1), layer.weight);
    u.from_1 = vec4(places.source.col(2), perspective.gain);
    u.beyond = vec4(places.beyond, slots[i].map);
    set_camera(u, perspective, layer, settings);
    data.layers.push_back(u);
    data.cameras.push_back(perspective.camera);
  }
  share_map_scale(data.layers);
  kind.one_camera = std::all_of(data.layers.begin(), data.layers.end(),
                                [&](const auto& u) { return u.same_camera(data.layers.front()); });
  return data;
}

}  // namespace lumibox::render
