#pragma once

#include <memory>

#include "hal/clock.h"
#include "hal/display.h"
#include "hal/window/key_edges.h"

namespace lumibox::hal {

/// A window on a desktop (X11, or XWayland), for work on a laptop with its own webcam. The picture
/// keeps its size; in a window of another it is scaled, with black beside it. Everything happens on
/// the main thread. A reset of the GPU is not noticed: open the window anew.
class WindowDisplay : public Display {
 public:
  /// `width` x `height`, pixels: of the picture, and of the window at first. As long as somebody
  /// has `keys`, what is typed goes there, seen by `clock`. Throws config::InputError where there
  /// is no desktop or it has no OpenGL ES 3.
  WindowDisplay(int width, int height, std::weak_ptr<KeyEdges> keys, const Clock& clock);
  ~WindowDisplay() override;

  int width() const override;
  int height() const override;
  void make_current() override;
  unsigned framebuffer() const override;
  void present() override;  ///< and hears what the desktop has to say
  std::int64_t presented() const override;
  bool lost() const override { return false; }
  void renew() override;
  bool closed() const override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::hal
