#include "render/reference.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "render/blending.h"
#include "render/depth_grid.h"
#include "render/light.h"
#include "render/sampling.h"

namespace lumibox::render {
namespace {

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

Ray ray_of_pixel(const View& view, int u, int v) {
  const config::CameraProfile& c = view.camera.profile();
  const Eigen::Vector3d direction((u - c.cx) / c.fx, (v - c.cy) / c.fy, 1.0);
  return {view.world_from_camera.translation, view.world_from_camera.rotation * direction};
}

/// Where the ray meets the plane through S, before its origin.
std::optional<Eigen::Vector3d> intersect(const Ray& ray, const Eigen::Vector3d& normal,
                                         const Eigen::Vector3d& focus) {
  const double t = normal.dot(focus - ray.origin) / normal.dot(ray.direction);
  if (!(t > 0.0) || !std::isfinite(t)) return std::nullopt;
  return ray.origin + t * ray.direction;
}

/// What one perspective shows at a pixel of the view: its light there, and its weight (wide) or
/// alpha (small) after feathering, 0 where it shows nothing.
struct Contribution {
  Eigen::Vector3d light = Eigen::Vector3d::Zero();
  double weight = 0.0;
  double closeness = 1.0;  ///< on a shape, see render::closeness
};

Contribution contribution(const Ray& ray, const Layer& layer,
                          const lightfield::Perspective& perspective, const hal::Image& image,
                          const Settings& settings) {
  const std::optional<Eigen::Vector3d> point = intersect(ray, layer.normal, settings.focus);
  if (!point) return {};
  const std::optional<Eigen::Vector2d> pixel =
      perspective.camera->project(perspective.world_from_camera.inverse() * *point);
  if (!pixel) return {};
  const double fade = feather(*pixel, image.width(), image.height(), settings.feather_px);
  if (fade <= 0.0) return {};
  return {perspective.gain * light_of(sample_bilinear(image, *pixel)), layer.weight * fade};
}

/// The same where the pixel's ray meets a shape at an inverse depth.
Contribution contribution_on_shape(const Eigen::Vector3d& pixel_of_view, double inverse_depth,
                                   const Layer& layer, const lightfield::Perspective& perspective,
                                   const hal::Image& image, const Settings& settings) {
  const Eigen::Vector3d ray_of_view = layer.source_from_pixel * pixel_of_view;
  const Eigen::Vector3d ray_of_source = ray_of_view + inverse_depth * layer.shift;
  const std::optional<Eigen::Vector2d> pixel = perspective.camera->project(ray_of_source);
  if (!pixel) return {};
  const double fade = feather(*pixel, image.width(), image.height(), settings.feather_px);
  if (fade <= 0.0) return {};
  double close = closeness(ray_of_view, ray_of_source);
  if (layer.map && inverse_depth > 0.0) {
    close *= visibility(layer.map->along(ray_of_source), inverse_depth / ray_of_source.z());
  }
  return {perspective.gain * light_of(sample_bilinear(image, *pixel)), layer.weight * fade, close};
}

/// Thesis 3.2, wide aperture: weighted mean; on a shape the closer ones count more.
CoveredLight blend_wide(const std::vector<Contribution>& contributions, bool on_shape) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double close_total = 0.0;
  double total = 0.0;
  for (const Contribution& c : contributions) {
    sum += c.closeness * c.weight * c.light;
    close_total += c.closeness * c.weight;
    total += c.weight;
  }
  const double covered =
      total / std::max(total, least_total_weight(contributions.size(), on_shape));
  if (!(close_total > 0.0)) return {Eigen::Vector3d::Zero(), covered};
  return {sum * (covered / close_total), covered};
}

/// Thesis 3.2, small aperture: far to near, each "over" what is there.
CoveredLight blend_small(const std::vector<Contribution>& contributions) {
  CoveredLight blended;
  for (auto c = contributions.rbegin(); c != contributions.rend(); ++c) {
    blended.light = c->weight * c->light + (1.0 - c->weight) * blended.light;
    blended.covered = c->weight + (1.0 - c->weight) * blended.covered;
  }
  return blended;
}

using Pixels = std::shared_ptr<const hal::Image>;

std::vector<Pixels> pixels_of(const std::vector<Layer>& layers,
                              const std::vector<lightfield::Perspective>& perspectives) {
  std::vector<Pixels> pixels;
  for (const Layer& layer : layers) pixels.push_back(perspectives[layer.perspective].photo->rgb());
  return pixels;
}

}  // namespace

std::vector<CoveredLight> reference_light(const View& view,
                                          const std::vector<lightfield::Perspective>& perspectives,
                                          const Settings& settings) {
  std::vector<Layer> layers;
  std::vector<Pixels> pixels;
  do {  // a picture that turns out to be lost is left out from then on
    layers = plan_view(view, perspectives, settings);
    pixels = pixels_of(layers, perspectives);
  } while (std::ranges::find(pixels, nullptr) != pixels.end());
  std::vector<CoveredLight> light;
  std::vector<Contribution> contributions(layers.size());
  for (int v = 0; v < view.camera.height(); ++v) {
    for (int u = 0; u < view.camera.width(); ++u) {
      const Ray ray = ray_of_pixel(view, u, v);
      for (std::size_t i = 0; i < layers.size(); ++i) {
        const lightfield::Perspective& perspective = perspectives[layers[i].perspective];
        contributions[i] =
            settings.shape
                ? contribution_on_shape(Eigen::Vector3d(u, v, 1.0), settings.shape->grid.at(u, v),
                                        layers[i], perspective, *pixels[i], settings)
                : contribution(ray, layers[i], perspective, *pixels[i], settings);
      }
      light.push_back(settings.shape || settings.aperture == Aperture::Wide
                          ? blend_wide(contributions, settings.shape != nullptr)
                          : blend_small(contributions));
    }
  }
  return light;
}

hal::Image stored_picture(const std::vector<CoveredLight>& light, int width, int height) {
  hal::Image image(width, height, 3);
  auto pixel = light.begin();
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u, ++pixel) {
      for (int channel = 0; channel < 3; ++channel) {
        const double stored = stored_of(pixel->light[channel]);
        image.at(u, v)[channel] = static_cast<std::uint8_t>(std::lround(stored));
      }
    }
  }
  return image;
}

hal::Image render_reference(const View& view,
                            const std::vector<lightfield::Perspective>& perspectives,
                            const Settings& settings) {
  return stored_picture(reference_light(view, perspectives, settings), view.camera.width(),
                        view.camera.height());
}

}  // namespace lumibox::render
