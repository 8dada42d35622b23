#pragma once

#include <cstdint>
#include <vector>

#include "render/layer_uniforms.h"

namespace lumibox::render {

/// Which layers each part of a view needs: those that show something there, in their order, and
/// none behind one that is opaque all over the part.
struct Tiles {
  static constexpr std::uint8_t kEnd = 255;  ///< after the last layer of a list
  static_assert(kMaxLayers < kEnd);
  static constexpr std::size_t kMostEntries = 16384;  ///< bytes of a uniform block, at least

  /// Tiles beside each other that show the same, as tile.vert has them.
  struct Block {
    std::int32_t column = 0;
    std::int32_t row = 0;  ///< the lowest is 0, as gl_FragCoord has it
    std::int32_t columns = 1;
    std::int32_t rows = 1;
    std::int32_t shows = 0;  ///< its layer, or where in `lists` its list begins
  };

  int size = 1;                     ///< of a tile, pixels of the view both ways
  std::vector<Block> alone;         ///< a single layer shows there, opaque all over: no list needed
  std::vector<Block> mixed;         ///< all others
  std::vector<std::uint8_t> lists;  ///< of `mixed`
};

/// Precondition: data.kind.tiles(): then all is before the view and the layers' cameras.
Tiles tiles_of(const View& view, const LayerData& data);

}  // namespace lumibox::render
