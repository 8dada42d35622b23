#pragma once

#include <cstdint>
#include <vector>

#include "render/layer_uniforms.h"

namespace lumibox::render {

/// Which layers each part of a view needs: those that show something there, in their order, and
/// none behind one that is opaque all over the part. The shader goes through these alone.
struct Tiles {
  static constexpr std::uint8_t kEnd = 255;  ///< after the last layer of a tile
  static_assert(kMaxLayers < kEnd);

  int size = 1;                     ///< pixels of the view, both ways
  int across = 0;                   ///< tiles in a row
  int down = 0;                     ///< rows, the lowest first as gl_FragCoord has it
  std::size_t row = 0;              ///< entries for each tile: one more than there are layers
  std::vector<std::uint8_t> lists;  ///< of the tiles, row by row
};

/// Precondition: data.kind.tiles(): then the layers' sources are in pixels, and wholly before their
/// cameras.
Tiles tiles_of(const View& view, const LayerData& data);

}  // namespace lumibox::render
