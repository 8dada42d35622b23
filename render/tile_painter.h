#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "render/gl.h"
#include "render/tiles.h"

namespace lumibox::render {

/// Draws the tiles of a view. All calls, the destructor included, need the same current context,
/// the layers' block bound, and their pictures in the unit for them.
class TilePainter {
 public:
  TilePainter();

  /// Whether lenses distort, and whether any layer has a gain other than 1.
  struct Needs {
    bool distortion = false;
    bool gains = false;
  };
  /// Those where one layer shows alone.
  void draw_alone(const Tiles& tiles, const Eigen::Vector2f& middle,
                  const Eigen::Vector2f& texel_size, const Needs& needs);

  /// All others, with the program in use: light_field.frag for tiles, its uniforms set.
  void draw_mixed(const Tiles& tiles);

 private:
  struct Alone {
    gl::Program program;
    GLint tile_size = -1;
    GLint middle = -1;
    GLint texel_size = -1;

    explicit Alone(const Needs& needs);
  };

  void draw(const std::vector<Tiles::Block>& blocks);

  gl::VertexArray vertex_array_;
  gl::Buffer instances_;
  gl::Buffer lists_;
  std::array<std::optional<Alone>, 4> alone_;  ///< by needs; compiled when needed
};

}  // namespace lumibox::render
