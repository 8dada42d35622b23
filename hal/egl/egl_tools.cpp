#include "hal/egl/egl_tools.h"

#include <array>
#include <cstdio>
#include <sstream>

#include "config/error.h"

namespace lumibox::hal::egl {

void fail(std::string_view display, const std::string& step, EGLint error) {
  std::array<char, 16> code{};
  std::snprintf(code.data(), code.size(), "0x%04x", static_cast<unsigned>(error));
  throw config::InputError(std::string(display) + ": " + step + " failed (EGL error " +
                           code.data() + "); is a driver for EGL and OpenGL ES 3 installed?");
}

bool lists(const char* extensions, std::string_view name) {
  std::istringstream words(extensions == nullptr ? "" : extensions);
  for (std::string word; words >> word;) {
    if (word == name) {
      return true;
    }
  }
  return false;
}

EGLDisplay initialised(EGLDisplay display) {
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
    return EGL_NO_DISPLAY;
  }
  return display;
}

EGLContext create_context(EGLDisplay display, EGLConfig config) {
  if (eglBindAPI(EGL_OPENGL_ES_API) == EGL_FALSE) return EGL_NO_CONTEXT;
  for (const EGLint minor : {1, 0}) {
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, minor,
                              EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    if (context != EGL_NO_CONTEXT) {
      return context;
    }
  }
  return EGL_NO_CONTEXT;
}

}  // namespace lumibox::hal::egl
