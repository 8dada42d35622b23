#pragma once

#include <cstdint>

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

  /// Pictures presented by now that came where they belong: on the screen, or nowhere if there is
  /// nobody to see one. Stands still while the driver takes pictures but shows none.
  virtual std::int64_t presented() const = 0;

  /// True if the context is gone with all that was in it, as after a reset of the GPU: known from
  /// the next present() or make_current() on. What is drawn until renew() goes nowhere.
  virtual bool lost() const = 0;

  /// A new context in place of one that is lost, current on the calling thread; names of objects in
  /// the old one mean nothing in it, so their owners must end before. Throws config::InputError.
  virtual void renew() = 0;

  /// True once who looks has closed it: the run is to end. A screen cannot be closed.
  virtual bool closed() const { return false; }
};

}  // namespace lumibox::hal
