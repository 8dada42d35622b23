#include "hal/offscreen/egl_context.h"

#include <EGL/eglext.h>

#include <array>
#include <mutex>
#include <string>

#include "hal/egl/egl_tools.h"

namespace lumibox::hal {
namespace {

using egl::initialised;
using egl::lists;

[[noreturn]] void fail(const std::string& step, EGLint error = eglGetError()) {
  egl::fail("offscreen display", step, error);
}

EGLDisplay open_first_device() {
  const auto query_devices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  if (query_devices == nullptr ||
      query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_FALSE) {
    return EGL_NO_DISPLAY;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const EGLDisplay display =
        initialised(eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
    if (display != EGL_NO_DISPLAY) {
      return display;
    }
  }
  return EGL_NO_DISPLAY;
}

EGLDisplay open_display() {
  const char* platforms = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  EGLDisplay display = EGL_NO_DISPLAY;
  if (lists(platforms, "EGL_MESA_platform_surfaceless")) {
    display = initialised(
        eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  }
  if (display == EGL_NO_DISPLAY && lists(platforms, "EGL_EXT_platform_device")) {
    display = open_first_device();
  }
  if (display == EGL_NO_DISPLAY) {
    fail("opening EGL without a screen");
  }
  return display;
}

EGLContext create_context(EGLDisplay display) {
  if (!lists(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
    fail("finding EGL_KHR_surfaceless_context");
  }
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_ES3_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, wanted, &config, 1, &count) == EGL_FALSE || count == 0) {
    fail("eglChooseConfig for OpenGL ES 3");
  }
  const EGLContext context = egl::create_context(display, config);
  if (context == EGL_NO_CONTEXT) fail("eglCreateContext for OpenGL ES 3");
  return context;
}

}  // namespace

// EGL hands out one display per platform and process; terminating it ends every context on it. So
// it is shared, and terminated with its last user.
std::shared_ptr<const EglDisplay> EglDisplay::shared() {
  static std::mutex mutex;
  static std::weak_ptr<const EglDisplay> current;
  const std::lock_guard lock(mutex);
  std::shared_ptr<const EglDisplay> display = current.lock();
  if (!display) {
    display.reset(new EglDisplay(open_display()));
    current = display;
  }
  return display;
}

EglDisplay::~EglDisplay() {
  eglTerminate(display_);
}

EglContext::EglContext()
    : display_(EglDisplay::shared()), context_(create_context(display_->handle())) {}

EglContext::~EglContext() {
  release();
  eglDestroyContext(display_->handle(), context_);
}

bool EglContext::make_current() const {
  if (eglMakeCurrent(display_->handle(), EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE) {
    return true;
  }
  const EGLint error = eglGetError();
  if (error != EGL_CONTEXT_LOST) fail("eglMakeCurrent", error);
  return false;
}

void EglContext::release() const {
  if (eglGetCurrentContext() == context_) {
    eglMakeCurrent(display_->handle(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
}

}  // namespace lumibox::hal
