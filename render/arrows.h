#pragma once

#include <Eigen/Core>
#include <span>

#include "render/strokes.h"

namespace lumibox::render {

/// A yellow line with a dark seam that ends in an arrow's head of this length (pixels). The head
/// points the way that the line's last piece has.
void draw_arrow(Strokes& strokes, std::span<const StrokePoint> points, float head, float scale);

/// An arrow near the edge of a picture of this size, clear of the lines of text at the top and at
/// the bottom, that points outwards in the direction `way` (right and down). Empty if that is zero.
Strokes edge_arrow(const Eigen::Vector2d& way, int width, int height);

}  // namespace lumibox::render
