#include "hal/sim/effects_file.h"

#include <algorithm>
#include <set>

namespace lumibox::hal::sim {
namespace {

std::uint64_t read_seed(CheckedTable& table) {
  return static_cast<std::uint64_t>(table.integer("seed", {0, 1e9}, 1));
}

LensDistortionSpec read_lens_distortion(CheckedTable& table, config::CameraProfile& camera) {
  LensDistortionSpec lens;
  lens.k1 = camera.k1 = table.number("k1", {-2.0, 2.0}, 0.0);
  lens.k2 = camera.k2 = table.number("k2", {-2.0, 2.0}, 0.0);
  lens.p1 = camera.p1 = table.number("p1", {-0.1, 0.1}, 0.0);
  lens.p2 = camera.p2 = table.number("p2", {-0.1, 0.1}, 0.0);
  lens.k3 = camera.k3 = table.number("k3", {-2.0, 2.0}, 0.0);
  return lens;
}

RollingShutterSpec read_rolling_shutter(CheckedTable& table, config::CameraProfile& camera) {
  RollingShutterSpec shutter;
  shutter.readout_s = camera.readout_s = table.number("readout_s", {1e-6, 1.0 / camera.fps});
  return shutter;
}

MotionBlurSpec read_motion_blur(CheckedTable& table, const config::CameraProfile& camera) {
  MotionBlurSpec blur;
  blur.exposure_s = table.number("exposure_s", {1e-6, 1.0 / camera.fps});
  blur.samples = table.integer("samples", {2, 256}, blur.samples);
  return blur;
}

AutoExposureSpec read_auto_exposure(CheckedTable& table) {
  AutoExposureSpec exposure;
  exposure.target = table.number("target", {0.01, 0.9}, exposure.target);
  exposure.lag_s = table.number("lag_s", {0.0, 60.0}, exposure.lag_s);
  exposure.min_gain = table.number("min_gain", {1e-3, 1.0}, exposure.min_gain);
  exposure.max_gain = table.number("max_gain", {1.0, 1e3}, exposure.max_gain);
  return exposure;
}

SensorNoiseSpec read_sensor_noise(CheckedTable& table) {
  SensorNoiseSpec noise;
  noise.full_well = table.number("full_well", {1.0, 1e7}, noise.full_well);
  noise.read = table.number("read", {0.0, 1e5}, noise.read);
  noise.seed = read_seed(table);
  return noise;
}

OpticsSpec read_optics(CheckedTable& table) {
  OpticsSpec optics;
  optics.depth = table.integer("depth", {1, 16}, optics.depth);
  return optics;
}

MovingSubjectSpec read_moving_subject(CheckedTable& table) {
  constexpr WobbleSpec kFidgeting{.min_hz = 0.1, .max_hz = 0.6};
  MovingSubjectSpec subject;
  subject.objects = table.texts("objects");
  subject.pivot = table.numbers("pivot", 3, {-1e4, 1e4});
  subject.wobble = read_wobble(table, kFidgeting);
  return subject;
}

OccluderSpec read_occluder(CheckedTable& table) {
  OccluderSpec occluder;
  occluder.size = table.numbers("size", 3, {1e-3, 1e4});
  occluder.from = table.numbers("from", 3, {-1e4, 1e4});
  occluder.to = table.numbers("to", 3, {-1e4, 1e4});
  occluder.start_s = table.number("start_s", {0.0, 1e5});
  occluder.duration_s = table.number("duration_s", {1e-3, 1e5});
  occluder.texture = table.text("texture", "");
  return occluder;
}

DroppedFramesSpec read_dropped_frames(CheckedTable& table) {
  DroppedFramesSpec dropped;
  dropped.share = table.number("share", {0.0, 1.0}, dropped.share);
  dropped.burst = table.integer("burst", {1, 100}, dropped.burst);
  dropped.seed = read_seed(table);
  return dropped;
}

void read_effect(Effect effect, CheckedTable& table, config::CameraProfile& camera,
                 EffectSpecs& effects) {
  switch (effect) {
    case Effect::LensDistortion:
      effects.lens_distortion = read_lens_distortion(table, camera);
      break;
    case Effect::RollingShutter:
      effects.rolling_shutter = read_rolling_shutter(table, camera);
      break;
    case Effect::MotionBlur:
      effects.motion_blur = read_motion_blur(table, camera);
      break;
    case Effect::Vignetting:
      effects.vignetting = VignettingSpec{table.number("corner", {0.0, 1.0})};
      break;
    case Effect::AutoExposure:
      effects.auto_exposure = read_auto_exposure(table);
      break;
    case Effect::SensorNoise:
      effects.sensor_noise = read_sensor_noise(table);
      break;
    case Effect::Reflection:
      effects.reflection = read_optics(table);
      break;
    case Effect::Refraction:
      effects.refraction = read_optics(table);
      break;
    case Effect::MovingSubject:
      effects.moving_subjects.push_back(read_moving_subject(table));
      break;
    case Effect::PassingOccluder:
      effects.occluders.push_back(read_occluder(table));
      break;
    case Effect::DroppedFrames:
      effects.dropped_frames = read_dropped_frames(table);
      break;
  }
}

}  // namespace

WobbleSpec read_wobble(CheckedTable& table, const WobbleSpec& fallback) {
  WobbleSpec wobble;
  wobble.position_mm = table.number("position_mm", {0.0, 1e4}, 0.0);
  wobble.rotation_deg = table.number("rotation_deg", {0.0, 90.0}, 0.0);
  wobble.min_hz = table.number("min_hz", {1e-3, 100.0}, fallback.min_hz);
  wobble.max_hz =
      table.number("max_hz", {wobble.min_hz, 100.0}, std::max(wobble.min_hz, fallback.max_hz));
  wobble.seed = read_seed(table);
  return wobble;
}

EffectSpecs read_effects(CheckedTable& root, config::CameraProfile& camera) {
  EffectSpecs effects;
  std::set<Effect> seen;
  for (CheckedTable& table : root.tables("effects")) {
    const auto effect = static_cast<Effect>(table.choice("kind", kEffectNames));
    const bool repeatable = effect == Effect::MovingSubject || effect == Effect::PassingOccluder;
    if (!seen.insert(effect).second && !repeatable) {
      table.fail("kind", "appears twice; this effect can be named once");
    }
    read_effect(effect, table, camera, effects);
    table.finish();
  }
  return effects;
}

void check_references(const SceneSpec& scene, const CheckedTable& root,
                      const std::vector<CheckedTable>& objects) {
  std::set<std::string> textures{""};
  for (const TextureSpec& texture : scene.textures) {
    if (!textures.insert(texture.name).second) {
      root.fail("textures", "two are named \"" + texture.name + "\"");
    }
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const ObjectSpec& object = scene.objects[i];
    if (!names.insert(object.name).second) {
      objects[i].fail("name", "\"" + object.name + "\" is taken by an object above");
    }
    if (!textures.contains(object.texture)) {
      objects[i].fail("texture", "no [[textures]] is named \"" + object.texture + "\"");
    }
    if (object.mirror > 0.0 && !scene.effects.reflection) {
      objects[i].fail("mirror", "needs [[effects]] kind = \"reflection\"");
    }
    if (object.glass_ior && !scene.effects.refraction) {
      objects[i].fail("glass_ior", "needs [[effects]] kind = \"refraction\"");
    }
  }
  for (const MovingSubjectSpec& subject : scene.effects.moving_subjects) {
    for (const std::string& name : subject.objects) {
      if (!names.contains(name)) root.fail("effects", "moving_subject: no object \"" + name + "\"");
    }
  }
  for (const OccluderSpec& occluder : scene.effects.occluders) {
    if (!textures.contains(occluder.texture)) {
      root.fail("effects", "passing_occluder: no texture \"" + occluder.texture + "\"");
    }
  }
}

}  // namespace lumibox::hal::sim
