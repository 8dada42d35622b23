#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/camera.h"
#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/image.h"
#include "hal/replay/sequence.h"
#include "hal/sim/scene.h"

namespace lumibox::bench {

/// Pictures in memory, so that nothing but the tracker is measured, and where they were taken.
struct Footage {
  struct Frame {
    std::int64_t timestamp_ns = 0;
    std::shared_ptr<const hal::Image> gray;
  };
  std::string name;
  geometry::Camera camera;
  std::vector<Frame> frames;
  std::vector<hal::StampedPose> truth;  ///< may be empty
};

/// Takes up to `count` pictures from a camera that has been started, at its own rate; fewer if the
/// camera ends before. `clock` is the one that the camera goes by. The truth is left to the caller.
Footage film(const std::string& name, hal::Camera& camera, hal::Clock& clock, std::int64_t count);

/// The first `count` pictures of a simulated camera and the truth about them; fewer if the scene
/// ends before.
Footage film_scene(const std::string& name, const std::shared_ptr<const hal::Scene>& scene,
                   std::int64_t count);

/// The same pictures halved, as a camera with half the pixels would have taken them.
Footage halved(const Footage& footage);

}  // namespace lumibox::bench
