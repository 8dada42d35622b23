#pragma once

#include <cstdint>
#include <optional>

#include "config/camera_profile.h"
#include "hal/frame.h"

namespace lumibox::hal {

enum class CameraState {
  Stopped,    ///< before start() or after stop()
  Streaming,  ///< frames come
  Ended,      ///< a recording is over; start() begins it anew
  Lost,       ///< the device went away; the backend tries to get it back by itself
};

/// Since the camera object was made, over all starts.
struct CameraCounters {
  std::int64_t delivered = 0;  ///< frames handed out by take_newest()
  std::int64_t dropped = 0;    ///< frames made but overwritten by a newer one, or lost on the way
};

/// A source of frames behind a one-slot mailbox: the newest frame wins and what it displaces is
/// counted. All backends pass tests/hal/camera_contract_test.cpp.
class Camera {
 public:
  virtual ~Camera() = default;

  /// Size, intrinsics and rate of the frames; fixed for the life of the object.
  virtual const config::CameraProfile& profile() const = 0;

  /// Begins the stream. Throws config::InputError that names the device or file, of a device that
  /// may come back config::Unavailable.
  virtual void start() = 0;
  virtual void stop() = 0;

  /// The newest frame not handed out yet, or none. Never blocks for longer than decoding one frame.
  /// A damaged recording throws config::InputError that names the file.
  virtual std::optional<Frame> take_newest() = 0;

  virtual CameraState state() const = 0;
  virtual CameraCounters counters() const = 0;

  /// Holds (or frees) focus, exposure and white balance, so that pictures of one subject match.
  /// Backends without such controls ignore it.
  virtual void lock_exposure(bool locked) = 0;
};

}  // namespace lumibox::hal
