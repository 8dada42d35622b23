#pragma once

#include <string>

#include "render/gl.h"
#include "render/layer_uniforms.h"

namespace lumibox::render {

/// Binding points of the uniform blocks, and units of the textures.
inline constexpr GLuint kLayersBlock = 0;
inline constexpr GLuint kListsBlock = 1;
inline constexpr GLint kPicturesUnit = 0;
inline constexpr GLint kInverseDepthsUnit = 1;
inline constexpr GLint kMapsUnit = 2;

/// layers.glsl with what it needs defined.
std::string layers_block();

/// light_field.frag, compiled for one kind of view. Of a kind that goes by tiles it draws those
/// that are mixed.
struct LayerProgram {
  gl::Program program;
  GLint layer_count = -1;
  GLint middle = -1;
  GLint texel_size = -1;
  GLint least_total_weight = -1;
  GLint stop = -1;
  GLint cells = -1;
  GLint map_texel_size = -1;
  GLint tile_size = -1;

  explicit LayerProgram(const Kind& kind);
};

}  // namespace lumibox::render
