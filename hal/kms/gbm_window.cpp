#include "hal/kms/gbm_window.h"

#include <EGL/eglext.h>
#include <drm_fourcc.h>
#include <gbm.h>
#include <xf86drmMode.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <vector>

#include "config/error.h"
#include "config/error_text.h"
#include "hal/egl/egl_tools.h"
#include "hal/kms/output.h"

namespace lumibox::hal::kms {
namespace {

/// Eight bits a colour before fewer, and what needs no alpha first.
constexpr std::array<std::uint32_t, 5> kFormats = {DRM_FORMAT_XRGB8888, DRM_FORMAT_ARGB8888,
                                                   DRM_FORMAT_XBGR8888, DRM_FORMAT_ABGR8888,
                                                   DRM_FORMAT_RGB565};

[[noreturn]] void fail(const std::string& step) {
  egl::fail("display kms", step);
}

[[noreturn]] void fail_with_errno(const std::string& step) {
  throw config::InputError("display kms: " + step + " failed: " + config::error_text(errno));
}

std::vector<EGLConfig> window_configs(EGLDisplay display) {
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_WINDOW_BIT, EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_ES3_BIT, EGL_NONE};
  EGLint count = 0;
  eglChooseConfig(display, wanted, nullptr, 0, &count);
  std::vector<EGLConfig> configs(static_cast<std::size_t>(count));
  eglChooseConfig(display, wanted, configs.data(), count, &count);
  configs.resize(static_cast<std::size_t>(count));
  return configs;
}

std::uint32_t format_of(EGLDisplay display, EGLConfig config) {
  EGLint format = 0;
  eglGetConfigAttrib(display, config, EGL_NATIVE_VISUAL_ID, &format);
  return static_cast<std::uint32_t>(format);
}

/// What the card calls a buffer; kept with the buffer, and ends with it.
struct Framebuffer {
  int card;
  std::uint32_t id;
};

void end_framebuffer(gbm_bo* /*buffer*/, void* data) {
  const std::unique_ptr<Framebuffer> framebuffer(static_cast<Framebuffer*>(data));
  drmModeRmFB(framebuffer->card, framebuffer->id);
}

}  // namespace

GbmDevice::GbmDevice(int card, std::span<const std::uint32_t> shown)
    : card_(card), gbm_(gbm_create_device(card)) {
  if (gbm_ == nullptr) fail_with_errno("opening GBM, which allocates pictures");
  try {
    egl_ = egl::initialised(eglGetPlatformDisplay(EGL_PLATFORM_GBM_KHR, gbm_, nullptr));
    if (egl_ == EGL_NO_DISPLAY) fail("opening EGL on GBM");
    choose_config(shown);
  } catch (...) {
    if (egl_ != EGL_NO_DISPLAY) eglTerminate(egl_);
    gbm_device_destroy(gbm_);
    throw;
  }
}

GbmDevice::~GbmDevice() {
  eglTerminate(egl_);
  gbm_device_destroy(gbm_);
}

void GbmDevice::choose_config(std::span<const std::uint32_t> shown) {
  const std::vector<EGLConfig> configs = window_configs(egl_);
  const auto config_with = [&](std::uint32_t format) {
    return std::ranges::find_if(
        configs, [&](EGLConfig config) { return format_of(egl_, config) == format; });
  };
  std::vector<std::uint32_t> drawn;
  std::ranges::copy_if(kFormats, std::back_inserter(drawn),
                       [&](std::uint32_t format) { return config_with(format) != configs.end(); });
  const auto format = choose_format(shown, drawn);
  if (!format) fail("finding a format of pixels that is both drawn and shown");
  format_ = *format;
  config_ = *config_with(format_);
}

GbmWindow::GbmWindow(const GbmDevice& device, Size size)
    : device_(device),
      size_(size),
      gbm_(gbm_surface_create(device.gbm(), static_cast<std::uint32_t>(size.width),
                              static_cast<std::uint32_t>(size.height), device.format(),
                              GBM_BO_USE_SCANOUT | GBM_BO_USE_RENDERING)) {
  if (gbm_ == nullptr) fail_with_errno("allocating buffers for the screen");
  surface_ = eglCreatePlatformWindowSurface(device.egl(), device.config(), gbm_, nullptr);
  if (surface_ == EGL_NO_SURFACE) {
    gbm_surface_destroy(gbm_);
    fail("eglCreatePlatformWindowSurface");
  }
}

GbmWindow::~GbmWindow() {
  for (const auto& [framebuffer, buffer] : locked_) gbm_surface_release_buffer(gbm_, buffer);
  eglDestroySurface(device_.egl(), surface_);
  gbm_surface_destroy(gbm_);
}

std::uint32_t GbmWindow::lock() {
  gbm_bo* buffer = gbm_surface_lock_front_buffer(gbm_);
  if (buffer == nullptr) fail_with_errno("taking a buffer from GBM");
  const std::uint32_t framebuffer = framebuffer_of(buffer);
  locked_[framebuffer] = buffer;
  return framebuffer;
}

std::uint32_t GbmWindow::framebuffer_of(gbm_bo* buffer) const {
  if (const void* known = gbm_bo_get_user_data(buffer)) {
    return static_cast<const Framebuffer*>(known)->id;
  }
  const std::array<std::uint32_t, 4> handles = {gbm_bo_get_handle(buffer).u32};
  const std::array<std::uint32_t, 4> strides = {gbm_bo_get_stride(buffer)};
  const std::array<std::uint32_t, 4> offsets = {gbm_bo_get_offset(buffer, 0)};
  auto framebuffer = std::make_unique<Framebuffer>(Framebuffer{device_.card(), 0});
  if (drmModeAddFB2(device_.card(), gbm_bo_get_width(buffer), gbm_bo_get_height(buffer),
                    gbm_bo_get_format(buffer), handles.data(), strides.data(), offsets.data(),
                    &framebuffer->id, 0) != 0) {
    fail_with_errno("drmModeAddFB2");
  }
  const std::uint32_t id = framebuffer->id;
  gbm_bo_set_user_data(buffer, framebuffer.release(), end_framebuffer);
  return id;
}

void GbmWindow::release(std::uint32_t framebuffer) {
  const auto found = locked_.find(framebuffer);
  if (found == locked_.end()) return;
  gbm_surface_release_buffer(gbm_, found->second);
  locked_.erase(found);
}

}  // namespace lumibox::hal::kms
