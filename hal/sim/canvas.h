#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "hal/sim/color.h"
#include "hal/sim/scene_spec.h"

namespace lumibox::hal::sim {

/// A tile to paint on, in metres from its upper left corner, colours in sRGB. What leaves one edge
/// comes in at the opposite one.
class Canvas {
 public:
  Canvas(const TextureSpec& spec, const Color& background)
      : image_(spec.texels_x, spec.texels_y),
        texel_m_(spec.tile_m.x() / spec.texels_x, spec.tile_m.y() / spec.texels_y) {
    std::fill(image_.pixels.begin(), image_.pixels.end(), background);
  }

  int width() const { return image_.width; }
  int height() const { return image_.height; }
  Eigen::Vector2d size_m() const {
    return {texel_m_.x() * image_.width, texel_m_.y() * image_.height};
  }
  Color& at(int x, int y) { return image_.row(y)[x]; }
  Eigen::Vector2d center_of(int x, int y) const {
    return {(x + 0.5) * texel_m_.x(), (y + 0.5) * texel_m_.y()};
  }

  /// Paints where `distance(point)`, metres to the shape's outline and negative inside, says so;
  /// the outline is smoothed over one texel. Nothing farther than `reach` from `center` is asked.
  template <typename Distance>
  void paint(const Eigen::Vector2d& center, double reach, const Color& color, Distance distance) {
    const double texel = 0.5 * (texel_m_.x() + texel_m_.y());
    const int x0 = static_cast<int>(std::floor((center.x() - reach) / texel_m_.x() - 1.0));
    const int x1 = static_cast<int>(std::ceil((center.x() + reach) / texel_m_.x()));
    const int y0 = static_cast<int>(std::floor((center.y() - reach) / texel_m_.y() - 1.0));
    const int y1 = static_cast<int>(std::ceil((center.y() + reach) / texel_m_.y()));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const double cover = std::clamp(0.5 - distance(center_of(x, y)) / texel, 0.0, 1.0);
        if (cover > 0.0) blend(x, y, color, static_cast<float>(cover));
      }
    }
  }

  void disc(const Eigen::Vector2d& center, double radius, const Color& color) {
    paint(center, radius, color,
          [&](const Eigen::Vector2d& p) { return (p - center).norm() - radius; });
  }

  void ring(const Eigen::Vector2d& center, double radius, double thickness, const Color& color) {
    paint(center, radius + thickness, color, [&](const Eigen::Vector2d& p) {
      return std::abs((p - center).norm() - radius) - 0.5 * thickness;
    });
  }

  void stroke(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double thickness,
              const Color& color) {
    const Eigen::Vector2d along = to - from;
    const double length2 = std::max(along.squaredNorm(), 1e-18);
    paint(0.5 * (from + to), 0.5 * along.norm() + thickness, color, [&](const Eigen::Vector2d& p) {
      const double t = std::clamp((p - from).dot(along) / length2, 0.0, 1.0);
      return (p - from - t * along).norm() - 0.5 * thickness;
    });
  }

  /// A rectangle turned by `angle` radians about its centre.
  void rectangle(const Eigen::Vector2d& center, const Eigen::Vector2d& size, double angle,
                 const Color& color) {
    const Eigen::Vector2d u(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d v(-u.y(), u.x());
    paint(center, 0.5 * size.norm(), color, [&](const Eigen::Vector2d& p) {
      return std::max(std::abs((p - center).dot(u)) - 0.5 * size.x(),
                      std::abs((p - center).dot(v)) - 0.5 * size.y());
    });
  }

  /// The picture in linear light.
  LinearImage linear() const;

 private:
  void blend(int x, int y, const Color& color, float cover) {
    // Sizes are powers of two, so masking wraps negative coordinates too.
    Color& texel = image_.row(y & (image_.height - 1))[x & (image_.width - 1)];
    texel += cover * (color - texel);
  }

  LinearImage image_;
  Eigen::Vector2d texel_m_;
};

}  // namespace lumibox::hal::sim
