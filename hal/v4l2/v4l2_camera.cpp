#include "hal/v4l2/v4l2_camera.h"

#include <fmt/core.h>
#include <poll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <thread>
#include <utility>

#include "config/error.h"
#include "config/error_text.h"
#include "config/log.h"
#include "hal/owned.h"
#include "hal/v4l2/frame_slot.h"
#include "hal/v4l2/streamer.h"

namespace lumibox::hal {
namespace {

// Of a camera that nobody calibrated: what webcams have, more or less, as for a bare video.
constexpr double kAssumedFieldOfViewDeg = 60.0;

v4l2::Request request_of(const V4l2Options& options) {
  const config::Camera& wishes = options.wishes;
  v4l2::Request request;
  request.name = options.device;
  v4l2::Wish& wish = request.wish;
  wish.format = v4l2::format_named(wishes.format);
  wish.rate_hz = wishes.rate_hz;
  if (options.calibration) {
    const config::CameraProfile& profile = *options.calibration;
    if ((wishes.width != 0 && wishes.width != profile.width) ||
        (wishes.height != 0 && wishes.height != profile.height)) {
      throw config::InputError(fmt::format(
          "camera.width and camera.height are {} and {}; the camera is calibrated at {}x{}: "
          "expected that, or 0",
          wishes.width, wishes.height, profile.width, profile.height));
    }
    request.exact_size = true;
    wish.width = profile.width;
    wish.height = profile.height;
  } else {
    wish.width = wishes.width != 0 ? wishes.width : wish.width;
    wish.height = wishes.height != 0 ? wishes.height : wish.height;
  }
  return request;
}

v4l2::Connection connect_or_throw(v4l2::VideoSystem& system, const v4l2::Request& request) {
  auto found = v4l2::connect(system, request);
  if (const auto* fault = std::get_if<std::string>(&found)) {
    throw config::Unavailable("devices.camera: " + *fault);
  }
  return std::get<v4l2::Connection>(std::move(found));
}

config::CameraProfile assumed_profile(const v4l2::Mode& mode) {
  config::CameraProfile profile;
  profile.width = mode.width;
  profile.height = mode.height;
  profile.fx = mode.width / 2.0 / std::tan(kAssumedFieldOfViewDeg / 2.0 * std::numbers::pi / 180.0);
  profile.fy = profile.fx;
  profile.cx = (mode.width - 1) / 2.0;
  profile.cy = (mode.height - 1) / 2.0;
  return profile;
}

/// What is known of the camera, with the rate that it runs at.
config::CameraProfile profile_of(const V4l2Options& options, const v4l2::Mode& mode) {
  config::CameraProfile profile =
      options.calibration ? *options.calibration : assumed_profile(mode);
  const double rate = mode.interval.rate_hz();
  profile.fps = rate > 0.0 ? rate : options.wishes.rate_hz;
  return profile;
}

/// What there is to be said of a camera before its first picture: by level.
struct Introduction {
  std::string info;
  std::string warning;  ///< empty: none
};

Introduction introduction_of(const V4l2Options& options, const v4l2::Connection& connection) {
  Introduction words;
  words.info = fmt::format("camera {} has {}; chosen: {}", connection.name(), connection.offer,
                           v4l2::to_string(connection.layout.mode));
  if (!options.calibration) {
    words.warning = fmt::format(
        "camera {}: no calibration; a horizontal field of view of {:.0f} degrees is "
        "assumed",
        connection.name(), kAssumedFieldOfViewDeg);
  }
  return words;
}

v4l2::StreamSettings settings_of(const V4l2Options& options) {
  v4l2::StreamSettings settings;
  settings.readout_ns =
      options.calibration ? std::llround(1e9 * options.calibration->readout_s) : 0;
  settings.stall_periods = options.wishes.stall_periods;
  settings.power_line = v4l2::power_line_setting(options.wishes.power_line);
  return settings;
}

/// Wakes a thread that polls it.
class WakeUp {
 public:
  WakeUp() : file_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (fd() < 0) throw config::InputError("eventfd: " + config::error_text(errno));
  }

  int fd() const { return file_.descriptor(); }
  void ring() { eventfd_write(fd(), 1); }
  void clear() {
    eventfd_t count = 0;
    eventfd_read(fd(), &count);
  }

 private:
  File file_;
};

}  // namespace

class V4l2Camera::Impl {
 public:
  Impl(const V4l2Options& options, const Clock& clock, std::unique_ptr<v4l2::VideoSystem> system,
       Service service)
      : clock_(clock), service_(service), system_(std::move(system)) {
    const v4l2::Request request = request_of(options);
    v4l2::Connection connection = connect_or_throw(*system_, request);
    profile_ = profile_of(options, connection.layout.mode);
    introduction_ = introduction_of(options, connection);
    streamer_.emplace(*system_, slot_, request, std::move(connection), settings_of(options));
  }

  ~Impl() { stop(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  const config::CameraProfile& profile() const { return profile_; }
  CameraState state() const { return streamer_->state(); }
  CameraCounters counters() const { return slot_.counters(); }

  void start() {
    stop();
    if (const auto fault = streamer_->start(clock_.now_ns())) {
      throw config::Unavailable("devices.camera: " + *fault);
    }
    introduce();
    if (service_ == Service::Thread) thread_ = std::thread([this] { run(); });
  }

  void stop() {
    if (thread_.joinable()) {
      stopping_ = true;
      wake_up_.ring();
      thread_.join();
      stopping_ = false;
    }
    streamer_->stop();
  }

  std::optional<Frame> take_newest() {
    if (service_ == Service::Caller) streamer_->service(clock_.now_ns());
    return slot_.take();
  }

  /// Setting a control takes a webcam some milliseconds: not for the loop to wait for.
  void lock_exposure(bool locked) {
    streamer_->hold_exposure(locked);
    wake_up_.ring();
  }

 private:
  /// Once, and not before it streams: one that another program has may be tried for hours.
  void introduce() {
    if (!introduction_) return;
    config::log_info(introduction_->info);
    if (!introduction_->warning.empty()) config::log_warning(introduction_->warning);
    introduction_.reset();
  }

  void run() {
    while (!stopping_) {
      wait();
      streamer_->service(clock_.now_ns());
      slot_.decode_ahead();
    }
  }

  /// For the camera, a change of the devices, a wish of the loop's, or the time to do something.
  void wait() {
    pollfd events[] = {{streamer_->poll_fd(), POLLIN, 0},
                       {system_->watch_fd(), POLLIN, 0},
                       {wake_up_.fd(), POLLIN, 0}};  // poll() leaves out what is -1
    poll(events, std::size(events), milliseconds_until(streamer_->due_ns()));
    wake_up_.clear();
  }

  int milliseconds_until(std::int64_t due_ns) const {
    constexpr std::int64_t kLongestMs = 60'000;
    const std::int64_t now_ns = clock_.now_ns();
    if (due_ns <= now_ns) return 0;
    return static_cast<int>(std::min(kLongestMs, (due_ns - now_ns) / 1'000'000 + 1));
  }

  const Clock& clock_;
  Service service_;
  std::unique_ptr<v4l2::VideoSystem> system_;
  config::CameraProfile profile_;
  std::optional<Introduction> introduction_;
  v4l2::FrameSlot slot_;
  std::optional<v4l2::Streamer> streamer_;
  WakeUp wake_up_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

V4l2Camera::V4l2Camera(const V4l2Options& options, const Clock& clock,
                       std::unique_ptr<v4l2::VideoSystem> system, Service service)
    : impl_(std::make_unique<Impl>(options, clock, std::move(system), service)) {}
V4l2Camera::~V4l2Camera() = default;

const config::CameraProfile& V4l2Camera::profile() const {
  return impl_->profile();
}
void V4l2Camera::start() {
  impl_->start();
}
void V4l2Camera::stop() {
  impl_->stop();
}
std::optional<Frame> V4l2Camera::take_newest() {
  return impl_->take_newest();
}
CameraState V4l2Camera::state() const {
  return impl_->state();
}
CameraCounters V4l2Camera::counters() const {
  return impl_->counters();
}
void V4l2Camera::lock_exposure(bool locked) {
  impl_->lock_exposure(locked);
}

}  // namespace lumibox::hal
