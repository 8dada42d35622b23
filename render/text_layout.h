#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/font.h"
#include "render/overlay.h"

namespace lumibox::render {

/// A corner of a triangle of text.vert.
struct TextVertex {
  Eigen::Vector2f position;  ///< pixels from the top left corner
  Eigen::Vector2f texel;     ///< pixels of the font's atlas
  Color color;
};

/// Triangles of these lines: first the dark outlines of all, then the faces.
std::vector<TextVertex> lay_out(const std::vector<Text>& lines, Font& font);

}  // namespace lumibox::render
