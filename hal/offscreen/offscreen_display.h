#pragma once

#include <memory>

#include "hal/display.h"
#include "hal/image.h"

namespace lumibox::hal {

/// OpenGL ES 3 without a screen: EGL on Mesa's surfaceless platform, drawing into a framebuffer
/// object of its own.
class OffscreenDisplay : public Display {
 public:
  /// Throws config::InputError saying which EGL step failed.
  OffscreenDisplay(int width, int height);
  ~OffscreenDisplay() override;

  int width() const override;
  int height() const override;
  void make_current() override;
  unsigned framebuffer() const override;
  void present() override;
  std::int64_t presented() const override;
  bool lost() const override;
  void renew() override;

  /// What a reset of the GPU does, for tests: the context, which must be current, is gone with all
  /// that was in it, and an empty one that is good for nothing is current.
  void lose();

  /// What the framebuffer holds, three channels, top row first.
  Image read_back() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::hal
