#include "render/light_mean.h"

#include <numeric>
#include <string>

#include "render/shader_source.h"

namespace lumibox::render {
namespace {

void attach(const gl::Framebuffer& framebuffer, const gl::Texture& layers, int layer) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, layers.name(), 0, layer);
}

}  // namespace

LightMean::LightMean() : vertex_array_(gl::make_vertex_array()) {
  std::string prelude = "#define MOST " + std::to_string(kInGroup) + "\n";
  prelude += shader_source("light.glsl");
  program_ = gl::make_program("screen.vert", "mean.frag", prelude);
  count_ = gl::uniform(program_, "count");
  weights_ = gl::uniform(program_, "weights");
  least_cover_ = gl::uniform(program_, "least_cover");
}

gl::Texture LightMean::make_layers() const {
  gl::Texture layers = gl::make_texture(GL_TEXTURE_2D_ARRAY);
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_RGBA8, width_, height_, kInGroup);
  return layers;
}

void LightMean::begin(int width, int height) {
  if (width != width_ || height != height_) {
    width_ = width;
    height_ = height;
    pictures_ = make_layers();
    means_ = make_layers();
    picture_ = gl::make_framebuffer();
    mean_ = gl::make_framebuffer();
  }
  in_group_ = 0;
  groups_.clear();
  attach(picture_, pictures_, 0);
}

void LightMean::add() {
  if (++in_group_ == kInGroup) end_group();
  attach(picture_, pictures_, in_group_);
}

void LightMean::end_group() {
  attach(mean_, means_, static_cast<int>(groups_.size()));
  const auto count = static_cast<float>(in_group_);
  draw_mean(pictures_, std::vector(static_cast<std::size_t>(in_group_), 1.0F / count), 1.0F,
            mean_.name());
  groups_.push_back(count);
  in_group_ = 0;
}

void LightMean::draw(unsigned framebuffer) {
  if (in_group_ > 0) end_group();
  std::vector<float> weights = groups_;
  const float all = std::accumulate(weights.begin(), weights.end(), 0.0F);
  for (float& weight : weights) weight /= all;
  draw_mean(means_, weights, static_cast<float>(kLeastCover), framebuffer);
}

void LightMean::draw_mean(const gl::Texture& layers, const std::vector<float>& weights,
                          float least_cover, unsigned framebuffer) const {
  gl::begin(framebuffer, width_, height_, gl::Blend::Replace);
  glUseProgram(program_.name());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D_ARRAY, layers.name());
  glUniform1i(count_, static_cast<GLint>(weights.size()));
  glUniform1f(least_cover_, least_cover);
  glUniform1fv(weights_, static_cast<GLsizei>(weights.size()), weights.data());
  glBindVertexArray(vertex_array_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace lumibox::render
