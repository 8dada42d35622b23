#pragma once

#include <memory>

#include "hal/sim/color.h"
#include "hal/sim/hand_path.h"
#include "hal/sim/scene_spec.h"
#include "hal/sim/sim_camera.h"
#include "hal/sim/tracer.h"
#include "hal/sim/world.h"

namespace lumibox::hal::sim {

/// What a shutter works with; all outlive it.
struct Stage {
  World& world;
  const HandPath& path;
  Tracer& tracer;
};

/// How the time of an exposure is spread over the picture.
class Shutter {
 public:
  virtual ~Shutter() = default;

  /// Fills `image` with linear light. `time_s` is the middle of the exposure at the middle row.
  virtual void expose(double time_s, LinearImage& image, SimCost& cost) = 0;
};

/// All rows at one instant.
class GlobalShutter : public Shutter {
 public:
  explicit GlobalShutter(const Stage& stage) : stage_(stage) {}
  void expose(double time_s, LinearImage& image, SimCost& cost) override;

 private:
  Stage stage_;
};

/// Each row at its own instant, the top one first.
class RollingShutter : public Shutter {
 public:
  RollingShutter(const Stage& stage, const RollingShutterSpec& spec)
      : stage_(stage), readout_s_(spec.readout_s) {}
  void expose(double time_s, LinearImage& image, SimCost& cost) override;

 private:
  Stage stage_;
  double readout_s_;
};

/// The mean over the exposure time of what another shutter sees.
class MotionBlur : public Shutter {
 public:
  MotionBlur(std::unique_ptr<Shutter> inner, const MotionBlurSpec& spec)
      : inner_(std::move(inner)), spec_(spec) {}
  void expose(double time_s, LinearImage& image, SimCost& cost) override;

 private:
  std::unique_ptr<Shutter> inner_;
  MotionBlurSpec spec_;
};

/// The shutter that a scene's effects call for.
std::unique_ptr<Shutter> make_shutter(const Stage& stage, const EffectSpecs& effects);

/// Time from the first to the last row, and for which each row is exposed, of that shutter.
double readout_s(const EffectSpecs& effects);
double exposure_s(const EffectSpecs& effects);

}  // namespace lumibox::hal::sim
