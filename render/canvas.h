#pragma once

#include "render/gl.h"

namespace lumibox::render {

/// A picture on the GPU that is drawn into and shown later, in another size.
class Canvas {
 public:
  /// What was drawn is lost where the size changes.
  void set_size(int width, int height);

  int width() const { return width_; }    ///< pixels
  int height() const { return height_; }  ///< pixels
  unsigned framebuffer() const { return framebuffer_.name(); }

  /// Fills a framebuffer of the given size, with linear filtering.
  void show(unsigned framebuffer, int width, int height) const;

 private:
  int width_ = 0;
  int height_ = 0;
  gl::Texture texture_;
  gl::Framebuffer framebuffer_;
};

}  // namespace lumibox::render
