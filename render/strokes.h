#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "render/overlay.h"

namespace lumibox::render {

/// A corner of a triangle of shape.vert.
struct StrokeVertex {
  Eigen::Vector2f position;  ///< pixels from the top left corner
  Eigen::Vector2f across;    ///< pixels from the centre line or the disc's centre
  float half_width = 0.0F;   ///< pixels
  Color color;
};

/// A point of a line on the screen and how opaque the line is there.
struct StrokePoint {
  Eigen::Vector2f position;  ///< pixels
  float opacity = 1.0F;
};

/// Factor for sizes given for a picture of 480 rows; on small screens lines stay a pixel wide.
float stroke_scale(int height);

/// Smooth lines and discs as triangles, in drawing order; shape.frag antialiases their edges.
class Strokes {
 public:
  /// A line through the points. Neighbouring pieces share their corners, so that a translucent
  /// line has no dots at its joints; meant for curves whose pieces turn only a little.
  void line(std::span<const StrokePoint> points, float half_width, const Color& color);

  void disc(const Eigen::Vector2f& center, float radius, const Color& color);

  const std::vector<StrokeVertex>& vertices() const { return vertices_; }

 private:
  void quad(const StrokeVertex& a, const StrokeVertex& b, const StrokeVertex& c,
            const StrokeVertex& d);

  std::vector<StrokeVertex> vertices_;
};

}  // namespace lumibox::render
