#pragma once

#include <EGL/egl.h>

#include <string>
#include <string_view>

/// What every display that draws through EGL needs of it.
namespace lumibox::hal::egl {

/// Throws config::InputError: "<display>: <step> failed" and what EGL says.
[[noreturn]] void fail(std::string_view display, const std::string& step,
                       EGLint error = eglGetError());

/// True if `name` is one of the words of an extension list; the list may be null.
bool lists(const char* extensions, std::string_view name);

/// The display if it can be initialised, else EGL_NO_DISPLAY.
EGLDisplay initialised(EGLDisplay display);

/// A context of OpenGL ES 3.1, or 3.0 where there is no other; EGL_NO_CONTEXT if there is neither.
EGLContext create_context(EGLDisplay display, EGLConfig config);

}  // namespace lumibox::hal::egl
