#include "hal/window/window_display.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "config/error.h"
#include "hal/kms/turned_picture.h"
#include "hal/owned.h"

namespace lumibox::hal {
namespace {

/// X11 counts keys as the kernel does, but from 8 on; Wayland as the kernel does.
constexpr int kX11FirstKey = 8;

[[noreturn]] void fail(const std::string& step) {
  const char* why = nullptr;
  glfwGetError(&why);
  throw config::InputError("display window: " + step +
                           " failed: " + (why == nullptr ? "no reason given" : why) +
                           "; expected a desktop with OpenGL ES 3");
}

/// The library, as long as there is a window.
struct Library {
  Library() {
    if (glfwInit() == GLFW_FALSE) fail("looking for a desktop");
  }
  ~Library() { glfwTerminate(); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

using WindowHandle = std::unique_ptr<GLFWwindow, Freed<glfwDestroyWindow>>;

/// A window with a context of OpenGL ES 3.1, or 3.0 where there is no other.
WindowHandle open_window(kms::Size size) {
  glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  for (const int minor : {1, 0}) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
    WindowHandle window(glfwCreateWindow(size.width, size.height, "Lumibox", nullptr, nullptr));
    if (window) {
      return window;
    }
  }
  fail("opening a window");
}

}  // namespace

// Members end from the last to the first: what lives in the window's context, the window, the
// library.
class WindowDisplay::Impl {
 public:
  Impl(kms::Size size, std::weak_ptr<KeyEdges> keys, const Clock& clock)
      : size_(size), keys_(std::move(keys)), clock_(clock) {
    if (std::string_view(glfwGetVersionString()).find("X11") != std::string_view::npos) {
      first_key_ = kX11FirstKey;
    }
    renew();
    glfwMakeContextCurrent(nullptr);  // until somebody asks for it, as of other displays
  }

  kms::Size size() const { return size_; }
  unsigned framebuffer() const { return picture_->framebuffer(); }
  std::int64_t presented() const { return presented_; }
  bool closed() const { return glfwWindowShouldClose(window_.get()) == GLFW_TRUE; }

  void make_current() {
    glfwMakeContextCurrent(window_.get());
    if (glfwGetCurrentContext() != window_.get()) fail("making the context current");
  }

  void present() {
    kms::Size window;
    glfwGetFramebufferSize(window_.get(), &window.width, &window.height);
    if (window.width > 0 && window.height > 0) {
      picture_->put(0, window, kms::Rotation::None);
    }
    glfwSwapBuffers(window_.get());
    ++presented_;
    glfwPollEvents();
  }

  void renew() {
    picture_.reset();
    window_.reset();
    window_ = open_window(size_);
    glfwSetWindowUserPointer(window_.get(), this);
    glfwSetKeyCallback(window_.get(), [](GLFWwindow* window, int, int key, int action, int) {
      static_cast<Impl*>(glfwGetWindowUserPointer(window))->take(key, action);
    });
    make_current();
    // The loop has a beat of its own; and of a hidden window some desktops never swap.
    glfwSwapInterval(0);
    picture_.emplace(size_);
  }

 private:
  void take(int key, int action) {
    const std::shared_ptr<KeyEdges> keys = keys_.lock();
    if (keys && key >= first_key_) {
      keys->push_back(
          {static_cast<unsigned>(key - first_key_), action != GLFW_RELEASE, clock_.now_ns()});
    }
  }

  Library library_;
  kms::Size size_;
  std::weak_ptr<KeyEdges> keys_;
  const Clock& clock_;
  int first_key_ = 0;
  WindowHandle window_;
  std::optional<kms::TurnedPicture> picture_;
  std::int64_t presented_ = 0;
};

WindowDisplay::WindowDisplay(int width, int height, std::weak_ptr<KeyEdges> keys,
                             const Clock& clock)
    : impl_(std::make_unique<Impl>(kms::Size{width, height}, std::move(keys), clock)) {}
WindowDisplay::~WindowDisplay() = default;

int WindowDisplay::width() const {
  return impl_->size().width;
}
int WindowDisplay::height() const {
  return impl_->size().height;
}
void WindowDisplay::make_current() {
  impl_->make_current();
}
unsigned WindowDisplay::framebuffer() const {
  return impl_->framebuffer();
}
void WindowDisplay::present() {
  impl_->present();
}
std::int64_t WindowDisplay::presented() const {
  return impl_->presented();
}
void WindowDisplay::renew() {
  impl_->renew();
}
bool WindowDisplay::closed() const {
  return impl_->closed();
}

}  // namespace lumibox::hal
