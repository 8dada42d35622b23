#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hal/image.h"
#include "hal/sim/image_stages.h"
#include "hal/sim/scene_impl.h"
#include "hal/sim/shutter.h"
#include "hal/sim/sim_camera.h"
#include "hal/sim/tracer.h"

namespace lumibox::hal::sim {

/// Makes the pictures of a scene: shutter, image stages, sRGB. Only what the scene names is
/// constructed here. One per stream, as exposure has a memory.
class FrameRenderer {
 public:
  /// `scene` outlives the renderer.
  explicit FrameRenderer(const Scene& scene);

  Image render(std::int64_t frame, bool exposure_locked, SimCost& cost);

 private:
  const Scene& scene_;
  Tracer tracer_;
  std::unique_ptr<Shutter> shutter_;
  std::vector<std::unique_ptr<ImageStage>> stages_;
  LinearImage light_;  ///< of the current frame; kept for its memory
};

/// True if the scene's effects lose this frame on its way.
bool is_dropped(const EffectSpecs& effects, std::int64_t frame);

}  // namespace lumibox::hal::sim
