#pragma once

#include <memory>

#include "hal/clock.h"
#include "hal/live/live_camera.h"
#include "hal/live/options.h"
#include "hal/v4l2/video_system.h"

namespace lumibox::hal {

/// A webcam, through Video4Linux2 (docs/camera.md). Devices are named by a path (/dev/video0,
/// /dev/v4l/by-id/...), a part of the camera's name, or "auto". The constructor opens and sets it
/// up, so that its profile is true. Throws config::InputError if the options make no sense, and
/// config::Unavailable, which names the device and what it has, if there is no camera that is what
/// they ask for.
class V4l2Camera : public LiveCamera {
 public:
  V4l2Camera(const CameraOptions& options, const Clock& clock,
             std::unique_ptr<v4l2::VideoSystem> system = v4l2::linux_video_system(),
             Service service = Service::Thread);
};

}  // namespace lumibox::hal
