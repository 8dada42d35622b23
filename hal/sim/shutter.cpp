#include "hal/sim/shutter.h"

namespace lumibox::hal::sim {
namespace {

geometry::Pose pose_at(const Stage& stage, double time_s, SimCost& cost) {
  if (stage.world.move_to(time_s)) ++cost.world_updates;
  ++cost.poses;
  return stage.path.world_from_camera(time_s);
}

}  // namespace

void GlobalShutter::expose(double time_s, LinearImage& image, SimCost& cost) {
  stage_.tracer.trace_rows(pose_at(stage_, time_s, cost), 0, image.height, image);
}

void RollingShutter::expose(double time_s, LinearImage& image, SimCost& cost) {
  const int last = image.height - 1;
  for (int row = 0; row < image.height; ++row) {
    const double row_time_s = time_s + readout_s_ * (static_cast<double>(row) / last - 0.5);
    stage_.tracer.trace_rows(pose_at(stage_, row_time_s, cost), row, row + 1, image);
  }
}

void MotionBlur::expose(double time_s, LinearImage& image, SimCost& cost) {
  LinearImage instant(image.width, image.height);
  std::fill(image.pixels.begin(), image.pixels.end(), Color::Zero());
  const auto share = 1.0f / static_cast<float>(spec_.samples);
  for (int i = 0; i < spec_.samples; ++i) {
    const double offset = (i + 0.5) / spec_.samples - 0.5;
    inner_->expose(time_s + offset * spec_.exposure_s, instant, cost);
    for (std::size_t p = 0; p < image.pixels.size(); ++p) {
      image.pixels[p] += share * instant.pixels[p];
    }
  }
}

std::unique_ptr<Shutter> make_shutter(const Stage& stage, const EffectSpecs& effects) {
  std::unique_ptr<Shutter> shutter;
  if (effects.rolling_shutter) {
    shutter = std::make_unique<RollingShutter>(stage, *effects.rolling_shutter);
  } else {
    shutter = std::make_unique<GlobalShutter>(stage);
  }
  if (effects.motion_blur) {
    shutter = std::make_unique<MotionBlur>(std::move(shutter), *effects.motion_blur);
  }
  return shutter;
}

double readout_s(const EffectSpecs& effects) {
  return effects.rolling_shutter ? effects.rolling_shutter->readout_s : 0.0;
}

double exposure_s(const EffectSpecs& effects) {
  return effects.motion_blur ? effects.motion_blur->exposure_s : 0.0;
}

}  // namespace lumibox::hal::sim
