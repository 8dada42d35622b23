#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"
#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/sim/scene.h"

namespace lumibox::hal {

/// What rendering cost: an effect that the scene does not name must not show up here.
struct SimCost {
  std::int64_t camera_rays = 0;     ///< from the lens into the scene
  std::int64_t secondary_rays = 0;  ///< shadow, reflected and refracted rays
  std::int64_t poses = 0;           ///< places of the hand that were computed
  std::int64_t world_updates = 0;   ///< times that moving objects were moved
  std::vector<std::string> stages;  ///< names of the image stages that ran, in order
};

/// A ray-traced camera walking through a scene.
class SimCamera : public Camera {
 public:
  SimCamera(std::shared_ptr<const Scene> scene, const Clock& clock);
  ~SimCamera() override;

  const config::CameraProfile& profile() const override;
  void start() override;
  void stop() override;
  std::optional<Frame> take_newest() override;
  CameraState state() const override;
  CameraCounters counters() const override;
  void lock_exposure(bool locked) override;

  /// Cost of the last frame.
  const SimCost& last_cost() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::hal
