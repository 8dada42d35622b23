#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <thread>

#include "config/camera_profile.h"
#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/live/device.h"
#include "hal/live/frame_slot.h"
#include "hal/live/options.h"
#include "hal/live/streamer.h"
#include "hal/live/wake_up.h"

namespace lumibox::hal {

/// Who looks after the camera: a thread of its own, or whoever takes frames, each time (nothing may
/// happen beside the loop where time is virtual).
enum class Service { Thread, Caller };

namespace live {

/// A device that is open and set to its mode, and what is known of it.
struct Prepared {
  std::unique_ptr<Device> device;
  config::CameraProfile profile;
  StreamSettings settings;
  Introduction introduction;
};

}  // namespace live

/// A real camera (docs/camera.md). start() throws config::Unavailable if it does not stream; one
/// that is lost later is waited for.
class LiveCamera : public Camera {
 public:
  LiveCamera(live::Prepared prepared, const Clock& clock, Service service);
  ~LiveCamera() override;
  LiveCamera(const LiveCamera&) = delete;
  LiveCamera& operator=(const LiveCamera&) = delete;

  const config::CameraProfile& profile() const override { return profile_; }
  void start() override;
  void stop() override;
  std::optional<Frame> take_newest() override;
  CameraState state() const override { return streamer_.state(); }
  CameraCounters counters() const override { return slot_.counters(); }
  void lock_exposure(bool locked) override;

 private:
  void introduce();
  void run();
  void wait();
  int milliseconds_until(std::int64_t due_ns) const;

  const Clock& clock_;
  Service service_;
  std::unique_ptr<live::Device> device_;
  config::CameraProfile profile_;
  std::optional<live::Introduction> introduction_;  ///< until it is said
  live::FrameSlot slot_;
  live::Streamer streamer_;
  live::WakeUp wake_up_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace lumibox::hal
