#pragma once

#include <EGL/egl.h>

#include <cstdint>
#include <map>
#include <span>

#include "hal/kms/mode.h"

struct gbm_bo;
struct gbm_device;
struct gbm_surface;

namespace lumibox::hal::kms {

/// EGL on a graphics card.
class GbmDevice {
 public:
  /// `card` is open and must stay so; `shown` are the formats (fourcc) that its screen shows.
  /// Throws config::InputError naming the step that failed.
  GbmDevice(int card, std::span<const std::uint32_t> shown);
  ~GbmDevice();
  GbmDevice(const GbmDevice&) = delete;
  GbmDevice& operator=(const GbmDevice&) = delete;

  int card() const { return card_; }
  gbm_device* gbm() const { return gbm_; }
  EGLDisplay egl() const { return egl_; }
  EGLConfig config() const { return config_; }
  std::uint32_t format() const { return format_; }

 private:
  void choose_config(std::span<const std::uint32_t> shown);

  int card_;
  gbm_device* gbm_;
  EGLDisplay egl_ = EGL_NO_DISPLAY;
  EGLConfig config_ = nullptr;
  std::uint32_t format_ = 0;
};

/// Buffers that GL draws into and the card shows. No context may be current on the window when it
/// ends.
class GbmWindow {
 public:
  GbmWindow(const GbmDevice& device, Size size);  ///< throws config::InputError
  ~GbmWindow();
  GbmWindow(const GbmWindow&) = delete;
  GbmWindow& operator=(const GbmWindow&) = delete;

  Size size() const { return size_; }
  EGLSurface surface() const { return surface_; }

  /// Of the buffer that eglSwapBuffers() just completed: its framebuffer for the card. It is drawn
  /// into again once it is released. Throws config::InputError.
  std::uint32_t lock();
  void release(std::uint32_t framebuffer);

 private:
  std::uint32_t framebuffer_of(gbm_bo* buffer) const;

  const GbmDevice& device_;
  Size size_;
  gbm_surface* gbm_;
  EGLSurface surface_ = EGL_NO_SURFACE;
  std::map<std::uint32_t, gbm_bo*> locked_;
};

}  // namespace lumibox::hal::kms
