#include "render/tile_painter.h"

#include <cstddef>
#include <string>

#include "render/layer_program.h"
#include "render/shader_source.h"

namespace lumibox::render {
namespace {

std::string definitions(const TilePainter::Needs& needs) {
  std::string text = "#define ALONE\n";
  text += needs.distortion ? "#define DISTORTION\n" : "";
  text += needs.gains ? "#define GAINS\n" : "";
  return text.append(layers_block());
}

/// Whole numbers, of a block each.
void add_attribute(GLuint location, GLint count, std::size_t offset) {
  glEnableVertexAttribArray(location);
  glVertexAttribIPointer(location, count, GL_INT, sizeof(Tiles::Block),
                         reinterpret_cast<const void*>(offset));
  glVertexAttribDivisor(location, 1);
}

std::string lens_and_light() {
  return std::string(shader_source("lens.glsl")).append(shader_source("light.glsl"));
}

}  // namespace

TilePainter::Alone::Alone(const Needs& needs)
    : program(gl::make_program("tile.vert", "alone.frag", definitions(needs), lens_and_light())),
      tile_size(gl::uniform(program, "tile_size")),
      middle(gl::uniform(program, "middle")),
      texel_size(gl::uniform(program, "texel_size")) {
  gl::bind_block(program, "Layers", kLayersBlock);
  glUseProgram(program.name());
  glUniform1i(gl::uniform(program, "pictures"), kPicturesUnit);
}

TilePainter::TilePainter()
    : vertex_array_(gl::make_vertex_array()),
      instances_(gl::make_buffer()),
      lists_(gl::make_buffer()) {
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
  add_attribute(0, 4, offsetof(Tiles::Block, column));
  add_attribute(1, 1, offsetof(Tiles::Block, shows));
  glBindBuffer(GL_UNIFORM_BUFFER, lists_.name());
  glBufferData(GL_UNIFORM_BUFFER, Tiles::kMostEntries, nullptr, GL_DYNAMIC_DRAW);
}

void TilePainter::draw_alone(const Tiles& tiles, const Eigen::Vector2f& middle,
                             const Eigen::Vector2f& texel_size, const Needs& needs) {
  std::optional<Alone>& alone = alone_[(needs.distortion ? 2U : 0U) + (needs.gains ? 1U : 0U)];
  if (!alone) alone.emplace(needs);
  glUseProgram(alone->program.name());
  glUniform1i(alone->tile_size, tiles.size);
  glUniform2f(alone->middle, middle.x(), middle.y());
  glUniform2f(alone->texel_size, texel_size.x(), texel_size.y());
  draw(tiles.alone);
}

void TilePainter::draw_mixed(const Tiles& tiles) {
  glBindBuffer(GL_UNIFORM_BUFFER, lists_.name());
  glBufferSubData(GL_UNIFORM_BUFFER, 0, static_cast<GLsizeiptr>(tiles.lists.size()),
                  tiles.lists.data());
  glBindBufferBase(GL_UNIFORM_BUFFER, kListsBlock, lists_.name());
  draw(tiles.mixed);
}

void TilePainter::draw(const std::vector<Tiles::Block>& blocks) {
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(blocks.size() * sizeof(Tiles::Block)),
               blocks.data(), GL_STREAM_DRAW);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(blocks.size()));
}

}  // namespace lumibox::render
