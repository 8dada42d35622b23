#include "hal/offscreen/egl_context.h"

#include <EGL/eglext.h>

#include <array>
#include <cstdio>
#include <mutex>
#include <sstream>
#include <string>
#include <string_view>

#include "config/error.h"

namespace lumibox::hal {
namespace {

[[noreturn]] void fail(const std::string& step, EGLint error = eglGetError()) {
  std::array<char, 16> code{};
  std::snprintf(code.data(), code.size(), "0x%04x", static_cast<unsigned>(error));
  throw config::InputError("offscreen display: " + step + " failed (EGL error " + code.data() +
                           "); is a driver for EGL and OpenGL ES 3 installed?");
}

/// True if `name` is one of the words of an extension list; the list may be null.
bool lists(const char* extensions, std::string_view name) {
  std::istringstream words(extensions == nullptr ? "" : extensions);
  for (std::string word; words >> word;) {
    if (word == name) {
      return true;
    }
  }
  return false;
}

/// The display if it can be initialised, else EGL_NO_DISPLAY.
EGLDisplay initialised(EGLDisplay display) {
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
    return EGL_NO_DISPLAY;
  }
  return display;
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
  if (eglBindAPI(EGL_OPENGL_ES_API) == EGL_FALSE) {
    fail("eglBindAPI");
  }
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_ES3_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, wanted, &config, 1, &count) == EGL_FALSE || count == 0) {
    fail("eglChooseConfig for OpenGL ES 3");
  }
  for (const EGLint minor : {1, 0}) {
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, minor,
                              EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    if (context != EGL_NO_CONTEXT) {
      return context;
    }
  }
  fail("eglCreateContext for OpenGL ES 3");
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
