#pragma once

#include <vector>

#include "hal/sim/canvas.h"
#include "hal/sim/random.h"

/// What the painters of textures share.
namespace lumibox::hal::sim {

/// Any of the colours.
const Color& pick(const std::vector<Color>& palette, Random& random);

/// A colour made brighter or darker, within [0, 1].
Color shade(const Color& color, double factor);

/// How many cells fit across; at least one.
int count(double extent, double cell);

/// A made-up letter: three to five strokes between the points of a 3 x 4 grid.
void glyph(Canvas& canvas, const Eigen::Vector2d& corner, double height, const Color& ink,
           Random& random);

/// Running bond; the first colour is the mortar.
Canvas paint_bricks(const TextureSpec& spec, Random& random);

/// Storeys of windows on masonry; cell_m is the distance between windows.
Canvas paint_facade(const TextureSpec& spec, Random& random);

/// Shelves of book spines with titles; cell_m is a book's height.
Canvas paint_books(const TextureSpec& spec, Random& random);

}  // namespace lumibox::hal::sim
