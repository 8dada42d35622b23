#pragma once

#include <memory>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/replay/sequence.h"

namespace lumibox::hal {

enum class Pacing {
  Lockstep,  ///< each take_newest() gives the next frame; none is dropped
  Recorded,  ///< frames appear when the clock has advanced as far as in the recording, to a quarter
             ///< of a frame period
};

/// A recording played as a camera.
class ReplayCamera : public Camera {
 public:
  ReplayCamera(Sequence sequence, const Clock& clock, Pacing pacing);
  ~ReplayCamera() override;

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
