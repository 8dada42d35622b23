#include "render/layer_program.h"

#include <fmt/core.h>

#include "render/shader_source.h"
#include "render/tiles.h"

namespace lumibox::render {
namespace {

std::string definitions(const Kind& kind) {
  std::string text = kind.small_aperture ? "#define SMALL_APERTURE\n" : "";
  text += kind.distortion ? "#define DISTORTION\n" : "";
  text += kind.horizon ? "#define HORIZON\n" : "";
  text += kind.one_camera ? "#define ONE_CAMERA\n" : "";
  if (kind.tiles()) {
    text += fmt::format("#define TILES\n#define END_OF_LIST {}\n#define MAX_ENTRIES {}\n",
                        Tiles::kEnd, Tiles::kMostEntries);
    if (kind.one_camera) text += "#define NEAR 8\n";
  }
  if (kind.shape) {
    text += fmt::format(
        "#define SHAPE\n#define FARTHER_PENALTY {:f}\n#define LEAST_PENALTY {:f}\n"
        "#define BEFORE {:f}\n#define HIDING {:f}\n#define HIDDEN {:f}\n",
        kFartherPenalty, kLeastPenalty, kBefore, kHiding, kHidden);
  }
  return text;
}

}  // namespace

std::string layers_block() {
  return fmt::format("#define MAX_LAYERS {}\n{}", kMaxLayers, shader_source("layers.glsl"));
}

LayerProgram::LayerProgram(const Kind& kind) {
  std::string shared = definitions(kind);
  shared += layers_block();
  if (kind.tiles()) shared += shader_source("lists.glsl");
  std::string lens_and_light(shader_source("lens.glsl"));
  lens_and_light += shader_source("light.glsl");
  program = gl::make_program(kind.tiles() ? "tile.vert" : "screen.vert", "light_field.frag", shared,
                             lens_and_light);
  layer_count = gl::uniform(program, "layer_count");
  middle = gl::uniform(program, "middle");
  texel_size = gl::uniform(program, "texel_size");
  least_total_weight = gl::uniform(program, "least_total_weight");
  stop = gl::uniform(program, "stop");
  gl::bind_block(program, "Layers", kLayersBlock);
  glUseProgram(program.name());
  glUniform1i(gl::uniform(program, "pictures"), kPicturesUnit);
  if (kind.tiles()) {
    tile_size = gl::uniform(program, "tile_size");
    gl::bind_block(program, "Lists", kListsBlock);
  }
  if (kind.shape) {
    cells = gl::uniform(program, "cells");
    map_texel_size = gl::uniform(program, "map_texel_size");
    glUniform1i(gl::uniform(program, "inverse_depths"), kInverseDepthsUnit);
    glUniform1i(gl::uniform(program, "maps"), kMapsUnit);
  }
}

}  // namespace lumibox::render
