#include "hal/offscreen/offscreen_display.h"

#include <GLES3/gl3.h>

#include <optional>
#include <string>
#include <vector>

#include "config/error.h"
#include "hal/offscreen/egl_context.h"

namespace lumibox::hal {

class OffscreenDisplay::Impl {
 public:
  Impl(int width, int height) : width_(width), height_(height) {
    renew();
    context_->release();  // so that another thread may take it
  }

  void renew() {
    context_.emplace();
    lost_ = !context_->make_current();
    GLint max_size = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &max_size);
    if (width_ < 1 || height_ < 1 || width_ > max_size || height_ > max_size) {
      throw size_error("expected 1 to " + std::to_string(max_size) + " pixels a side");
    }
    // Deleted with the context, which shares its objects with no other.
    glGenRenderbuffers(1, &color_);
    glBindRenderbuffer(GL_RENDERBUFFER, color_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width_, height_);
    glGenFramebuffers(1, &framebuffer_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw size_error("the driver gives no framebuffer of this size");
    }
  }

  int width() const { return width_; }
  int height() const { return height_; }
  unsigned framebuffer() const { return framebuffer_; }
  bool lost() const { return lost_; }
  std::int64_t presented() const { return presented_; }
  void make_current() { lost_ = !context_->make_current() || lost_; }

  void present() {
    glFlush();
    make_current();  // nothing else tells a loss here
    if (!lost_) ++presented_;
  }

  void lose() {
    context_.emplace();
    context_->make_current();
    lost_ = true;
  }

  Image read_back() const {
    context_->make_current();
    constexpr std::size_t kChannels = 4;  // RGBA bytes are what every ES 3 driver can read
    const auto row_bytes = static_cast<std::size_t>(width_) * kChannels;
    std::vector<std::uint8_t> pixels(row_bytes * static_cast<std::size_t>(height_));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());

    Image image(width_, height_, 3);
    for (int y = 0; y < height_; ++y) {
      const std::uint8_t* source =
          pixels.data() + static_cast<std::size_t>(height_ - 1 - y) * row_bytes;
      std::uint8_t* target = image.row(y);
      for (int x = 0; x < width_; ++x, source += kChannels, target += 3) {
        target[0] = source[0];
        target[1] = source[1];
        target[2] = source[2];
      }
    }
    return image;
  }

 private:
  config::InputError size_error(const std::string& expected) const {
    return config::InputError("offscreen display of " + std::to_string(width_) + "x" +
                              std::to_string(height_) + ": " + expected);
  }

  int width_;
  int height_;
  std::optional<EglContext> context_;
  GLuint color_ = 0;
  GLuint framebuffer_ = 0;
  bool lost_ = false;
  std::int64_t presented_ = 0;
};

OffscreenDisplay::OffscreenDisplay(int width, int height)
    : impl_(std::make_unique<Impl>(width, height)) {}
OffscreenDisplay::~OffscreenDisplay() = default;

int OffscreenDisplay::width() const {
  return impl_->width();
}
int OffscreenDisplay::height() const {
  return impl_->height();
}
void OffscreenDisplay::make_current() {
  impl_->make_current();
}
unsigned OffscreenDisplay::framebuffer() const {
  return impl_->framebuffer();
}
void OffscreenDisplay::present() {
  impl_->present();
}
std::int64_t OffscreenDisplay::presented() const {
  return impl_->presented();
}
bool OffscreenDisplay::lost() const {
  return impl_->lost();
}
void OffscreenDisplay::renew() {
  impl_->renew();
}
void OffscreenDisplay::lose() {
  impl_->lose();
}
Image OffscreenDisplay::read_back() const {
  return impl_->read_back();
}

}  // namespace lumibox::hal
