#pragma once

#include <memory>
#include <optional>
#include <string>

#include "config/config.h"
#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/v4l2/video_system.h"

namespace lumibox::hal {

struct V4l2Options {
  /// A path (/dev/video0, /dev/v4l/by-id/...), a part of the camera's name, or "auto": the first
  /// that will do.
  std::string device = "auto";
  /// Of the camera, in the size that it is to be used at; none: a field of view is assumed, and
  /// said.
  std::optional<config::CameraProfile> calibration;
  config::Camera wishes;
};

/// Who looks after the camera: a thread of its own, or whoever takes frames, each time (nothing may
/// happen beside the loop where time is virtual).
enum class Service { Thread, Caller };

/// A webcam, through Video4Linux2 (docs/camera.md). The constructor opens and sets it up, so that
/// its profile is true. Throws config::InputError if the options make no sense, and
/// config::Unavailable, which names the device and what it has, if there is no camera that is what
/// they ask for; so does start() if it does not stream. A camera that is lost later is waited for.
class V4l2Camera : public Camera {
 public:
  V4l2Camera(const V4l2Options& options, const Clock& clock,
             std::unique_ptr<v4l2::VideoSystem> system = v4l2::linux_video_system(),
             Service service = Service::Thread);
  ~V4l2Camera() override;

  const config::CameraProfile& profile() const override;
  void start() override;
  void stop() override;
  std::optional<Frame> take_newest() override;
  CameraState state() const override;
  CameraCounters counters() const override;
  void lock_exposure(bool locked) override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::hal
