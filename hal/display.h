#pragma once

namespace lumibox::hal {

/// A surface with an OpenGL ES 3 context of its own.
class Display {
 public:
  virtual ~Display() = default;

  virtual int width() const = 0;   ///< pixels
  virtual int height() const = 0;  ///< pixels

  /// Makes the context current on the calling thread. Throws config::InputError naming the device.
  virtual void make_current() = 0;

  /// Framebuffer object to draw the picture into; valid while the context is current. Row 0 of the
  /// viewport is the bottom row of the screen, as GL has it.
  virtual unsigned framebuffer() const = 0;

  /// Shows what was drawn.
  virtual void present() = 0;
};

}  // namespace lumibox::hal
