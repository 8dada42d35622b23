#pragma once

#include <EGL/egl.h>

#include <memory>

namespace lumibox::hal {

/// The EGL display without a screen, shared by all contexts of the process.
class EglDisplay {
 public:
  /// The display that is open already, or a new one: Mesa's surfaceless platform, else the first
  /// EGL device that works (drivers other than Mesa). Throws config::InputError.
  static std::shared_ptr<const EglDisplay> shared();

  ~EglDisplay();
  EglDisplay(const EglDisplay&) = delete;
  EglDisplay& operator=(const EglDisplay&) = delete;

  EGLDisplay handle() const { return display_; }

 private:
  explicit EglDisplay(EGLDisplay display) : display_(display) {}

  EGLDisplay display_;
};

/// An OpenGL ES 3 context that draws into framebuffer objects only.
class EglContext {
 public:
  EglContext();  ///< throws config::InputError that names the step that failed
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// On the calling thread. False if the context is lost (EGL_CONTEXT_LOST); throws
  /// config::InputError if anything else is wrong.
  bool make_current() const;
  void release() const;  ///< from the calling thread, if it is current there

 private:
  std::shared_ptr<const EglDisplay> display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace lumibox::hal
