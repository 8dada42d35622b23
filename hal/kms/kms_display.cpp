#include "hal/kms/kms_display.h"

#include <EGL/egl.h>
#include <GLES3/gl3.h>
#include <unistd.h>

#include "config/error.h"
#include "config/log.h"
#include "hal/egl/egl_tools.h"
#include "hal/kms/drm_card.h"
#include "hal/kms/gbm_window.h"
#include "hal/kms/scanout.h"
#include "hal/kms/turned_picture.h"
#include "hal/kms/virtual_terminal.h"

namespace lumibox::hal {
namespace {

/// A context on a GBM device.
class Context {
 public:
  explicit Context(const kms::GbmDevice& device)
      : device_(device), context_(egl::create_context(device.egl(), device.config())) {
    if (context_ == EGL_NO_CONTEXT) {
      egl::fail("display kms", "eglCreateContext for OpenGL ES 3");
    }
  }
  ~Context() {
    release();
    eglDestroyContext(device_.egl(), context_);
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// False if the context is lost.
  bool make_current(EGLSurface surface) const {
    return eglMakeCurrent(device_.egl(), surface, surface, context_) == EGL_TRUE ||
           is_loss("eglMakeCurrent");
  }

  /// Completes the picture on the surface; false if the context is lost.
  bool swap(EGLSurface surface) const {
    return eglSwapBuffers(device_.egl(), surface) == EGL_TRUE || is_loss("eglSwapBuffers");
  }

  void release() const {
    if (eglGetCurrentContext() == context_) {
      eglMakeCurrent(device_.egl(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
  }

 private:
  static bool is_loss(const char* step) {
    const EGLint error = eglGetError();
    if (error != EGL_CONTEXT_LOST) egl::fail("display kms", step, error);
    return false;
  }

  const kms::GbmDevice& device_;
  EGLContext context_;
};

kms::OpenCard open_and_hold(const KmsOptions& options) {
  kms::OpenCard opened = kms::open_card(options.card, options.mode);
  if (!opened.card->take_master()) {
    throw config::Unavailable("display kms:" + opened.path +
                              ": another program has the card; expected no desktop beside the box");
  }
  return opened;
}

}  // namespace

// Members end from the last to the first: the card, which puts back what was shown before, after
// all that draws on it, and the console's text after that.
class KmsDisplay::Impl : private kms::Buffers {
 public:
  Impl(const KmsOptions& options, const Clock& clock)
      : opened_(open_and_hold(options)),
        terminal_(kms::VirtualTerminal::on(STDIN_FILENO)),
        card_(std::move(opened_.card)),
        device_(card_->descriptor(), card_->formats(opened_.output.pipe)),
        rotation_(options.rotation),
        size_(kms::turned(opened_.output.mode.size, rotation_)),
        scanout_(*card_, terminal_.get(), *this, clock, options.mode, opened_.output) {
    window_.emplace(device_, opened_.output.mode.size);
    renew();
    show_black();
    context_->release();  // so that another thread may take it
    config::log_info("display: " + opened_.path + ", " + opened_.output.name + " in " +
                     kms::name_of(opened_.output.mode));
  }

  ~Impl() override { context_->release(); }

  int width() const { return size_.width; }
  int height() const { return size_.height; }
  bool lost() const { return lost_; }
  unsigned framebuffer() const { return is_turned() ? turned_->framebuffer() : 0; }
  std::int64_t presented() const { return scanout_.presented() - presented_black_; }

  void make_current() { lost_ = !context_->make_current(window_->surface()) || lost_; }

  void present() {
    scanout_.present();
    glFlush();       // a picture that was dropped
    make_current();  // nothing else tells a loss then
  }

  void renew() {
    turned_.reset();
    context_.reset();
    context_.emplace(device_);
    lost_ = false;
    make_current();
    make_turned();
  }

 private:
  void show_black() {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer());
    glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    scanout_.present();
    if (!scanout_.showing()) {
      throw config::InputError("display kms:" + opened_.path + ": the screen at " +
                               opened_.output.name + " cannot be switched on in " +
                               kms::name_of(opened_.output.mode) +
                               "; expected that no other program has the card, or another "
                               "display.mode");
    }
    presented_black_ = scanout_.presented();
  }

  /// Whether pictures are put on the panel in another shape than they are drawn in.
  bool is_turned() const { return rotation_ != kms::Rotation::None || window_->size() != size_; }

  void make_turned() {
    if (is_turned() && !turned_) turned_.emplace(size_);
  }

  std::optional<std::uint32_t> finish() override {
    if (is_turned()) turned_->put(0, window_->size(), rotation_);
    if (!context_->swap(window_->surface())) {
      lost_ = true;
      return std::nullopt;
    }
    return window_->lock();
  }

  void release(std::uint32_t framebuffer) override { window_->release(framebuffer); }

  void resize(kms::Size size) override {
    context_->release();
    window_.reset();
    window_.emplace(device_, size);
    make_current();
    make_turned();
  }

  kms::OpenCard opened_;
  std::unique_ptr<kms::VirtualTerminal> terminal_;
  std::unique_ptr<kms::DrmCard> card_;
  kms::GbmDevice device_;
  std::optional<kms::GbmWindow> window_;
  std::optional<Context> context_;
  std::optional<kms::TurnedPicture> turned_;
  kms::Rotation rotation_;
  kms::Size size_;  ///< of the picture, as it was at first
  kms::Scanout scanout_;
  std::int64_t presented_black_ = 0;
  bool lost_ = false;
};

KmsDisplay::KmsDisplay(const KmsOptions& options, const Clock& clock)
    : impl_(std::make_unique<Impl>(options, clock)) {}
KmsDisplay::~KmsDisplay() = default;

int KmsDisplay::width() const {
  return impl_->width();
}
int KmsDisplay::height() const {
  return impl_->height();
}
void KmsDisplay::make_current() {
  impl_->make_current();
}
unsigned KmsDisplay::framebuffer() const {
  return impl_->framebuffer();
}
void KmsDisplay::present() {
  impl_->present();
}
std::int64_t KmsDisplay::presented() const {
  return impl_->presented();
}
bool KmsDisplay::lost() const {
  return impl_->lost();
}
void KmsDisplay::renew() {
  impl_->renew();
}

}  // namespace lumibox::hal
