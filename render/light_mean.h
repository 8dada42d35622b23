#pragma once

#include <vector>

#include "render/gl.h"

namespace lumibox::render {

/// The mean, of light, of pictures that are drawn one after the other. No more than eight bits of a
/// sum can be kept on every GPU (OpenGL ES 3.0 draws into nothing finer), so it is a mean of means
/// of eight, each rounded once: together to a third of a level. Pixels count as far as their alpha
/// says that they are covered, as Renderer draws them.
class LightMean {
 public:
  /// Of the pictures that show a pixel, at least this share is divided by: where fewer do the mean
  /// fades to black.
  static constexpr double kLeastCover = 0.5;

  static constexpr int kInGroup = 8;
  static constexpr int kMost = kInGroup * kInGroup;  ///< pictures

  LightMean();

  /// From now on of other pictures, of this size.
  void begin(int width, int height);

  /// What the next picture is to be drawn into.
  unsigned framebuffer() const { return picture_.name(); }

  /// The picture drawn there counts. Precondition: fewer than kMost do.
  void add();

  /// Draws the mean into a framebuffer of the pictures' size. Precondition: there is a picture.
  void draw(unsigned framebuffer);

 private:
  gl::Texture make_layers() const;
  void draw_mean(const gl::Texture& layers, const std::vector<float>& weights, float least_cover,
                 unsigned framebuffer) const;
  void end_group();

  gl::Program program_;
  GLint count_;
  GLint weights_;
  GLint least_cover_;
  gl::VertexArray vertex_array_;
  int width_ = 0;
  int height_ = 0;
  gl::Texture pictures_;     ///< of a group
  gl::Texture means_;        ///< of the groups
  gl::Framebuffer picture_;  ///< the next of pictures_
  gl::Framebuffer mean_;     ///< the next of means_
  int in_group_ = 0;
  std::vector<float> groups_;  ///< pictures in each
};

}  // namespace lumibox::render
