#pragma once

#include "geometry/camera.h"
#include "hal/sim/hand_path.h"
#include "hal/sim/scene.h"
#include "hal/sim/scene_spec.h"
#include "hal/sim/world.h"

namespace lumibox::hal {

/// A scene's parts, for the simulator's own sources.
class Scene::Impl {
 public:
  explicit Impl(sim::SceneSpec scene)
      : spec(std::move(scene)),
        path(spec.path, spec.duration_s),
        world(std::make_unique<sim::World>(spec)) {}

  const sim::SceneSpec spec;
  const sim::HandPath path;
  const std::unique_ptr<sim::World> world;  ///< moves, if at all, under its own mutex
};

}  // namespace lumibox::hal
