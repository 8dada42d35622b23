#include "render/canvas.h"

#include <string>

#include "config/error.h"

namespace lumibox::render {

void Canvas::set_size(int width, int height) {
  if (width == width_ && height == height_) return;
  texture_ = gl::make_texture(GL_TEXTURE_2D);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, width, height);
  if (framebuffer_.name() == 0) framebuffer_ = gl::make_framebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_.name(), 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw config::InputError("the GPU cannot draw into a picture of " + std::to_string(width) +
                             "x" + std::to_string(height) + " pixels");
  }
  width_ = width;
  height_ = height;
}

void Canvas::show(unsigned framebuffer, int width, int height) const {
  glDisable(GL_SCISSOR_TEST);  // it holds for a blit too
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

}  // namespace lumibox::render
