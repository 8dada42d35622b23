#pragma once

#include <memory>
#include <string>

#include "hal/clock.h"
#include "hal/libcamera/camera_system.h"
#include "hal/live/live_camera.h"
#include "hal/live/options.h"

namespace lumibox::hal {

/// A camera, through libcamera (docs/camera.md): those of boards whose pictures are made by a
/// signal processor, and webcams. Cameras are named by their number in the list, their id, a part
/// of id or model, or "auto". The constructor opens and sets it up, so that its profile is true.
/// Throws config::InputError if the options make no sense, and config::Unavailable, which names the
/// camera and what it has, if there is no camera that is what they ask for.
class LibcameraCamera : public LiveCamera {
 public:
  LibcameraCamera(const CameraOptions& options, const Clock& clock,
                  std::unique_ptr<libcam::CameraSystem> system = libcam::real_camera_system(),
                  Service service = Service::Thread);
};

/// Every camera that libcamera finds, for a person: its number and names, the formats and sizes
/// that can be used, and what can be held or set; empty if there is none. Cameras that cannot be
/// opened are there with the reason.
std::string list_cameras(libcam::CameraSystem& system);

}  // namespace lumibox::hal
