#include "hal/sim/random_effects.h"

#include <Eigen/Geometry>

#include "hal/sim/random_textures.h"

namespace lumibox::hal::sim {
namespace {

std::uint64_t any_seed(Random& random) {
  return random.bits() >> 40;
}

/// A lens by what it does to the corner of the picture: barrels more often than cushions.
LensDistortionSpec random_lens(config::CameraProfile& camera, Random& random) {
  const Eigen::Vector2d corner(0.5 * camera.width / camera.fx, 0.5 * camera.height / camera.fy);
  const double radius2 = corner.squaredNorm();
  const double at_corner = random.uniform(-0.2, 0.06);
  LensDistortionSpec lens;
  lens.k1 = camera.k1 = at_corner / radius2;
  // Of the opposite sign, as fits of real lenses have it, and too small to fold.
  lens.k2 = camera.k2 = -random.uniform(0.1, 0.35) * at_corner / (radius2 * radius2);
  lens.p1 = camera.p1 = random.uniform(-1e-3, 1e-3);
  lens.p2 = camera.p2 = random.uniform(-1e-3, 1e-3);
  return lens;
}

/// Somebody's arm that passes between camera and subject in the middle of the walk.
OccluderSpec random_occluder(SceneSpec& scene, Random& random) {
  const std::vector<KeyPose>& keys = scene.path.keys;
  const KeyPose& key =
      keys[static_cast<std::size_t>(random.uniform(0.35, 0.7) * static_cast<double>(keys.size()))];
  const Eigen::Vector3d sight = scene.subject_center - key.position;
  const Eigen::Vector3d across = sight.cross(Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d middle = key.position + 0.5 * sight;
  const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
  OccluderSpec occluder;
  occluder.size = sight.norm() * random.uniform(0.12, 0.25) * Eigen::Vector3d(0.6, 0.6, 1.6);
  occluder.duration_s = random.uniform(2.5, 4.0);
  occluder.start_s = scene.path.lead_in_s + key.time_s - 0.5 * occluder.duration_s;
  // It stands at either end of its way, so both are well out of view.
  const Eigen::Vector3d away = 2.0 * side * sight.norm() * across;
  occluder.from = middle - away;
  occluder.to = middle + away;
  scene.textures.push_back(random_texture("sleeve", {Pattern::Plaid, Pattern::Noise},
                                          occluder.size.z(), occluder.size.z(), 0.002, random));
  occluder.texture = "sleeve";
  return occluder;
}

void add_effect(Effect effect, const std::vector<std::string>& subject, SceneSpec& scene,
                Random& random) {
  EffectSpecs& effects = scene.effects;
  switch (effect) {
    case Effect::LensDistortion:
      effects.lens_distortion = random_lens(scene.camera, random);
      break;
    case Effect::RollingShutter:
      scene.camera.readout_s = random.uniform(0.010, 0.028);
      effects.rolling_shutter = RollingShutterSpec{scene.camera.readout_s};
      break;
    case Effect::MotionBlur:
      effects.motion_blur = MotionBlurSpec{random.uniform(0.005, 0.02), 6};
      break;
    case Effect::Vignetting:
      effects.vignetting = VignettingSpec{random.uniform(0.45, 0.8)};
      break;
    case Effect::AutoExposure:
      effects.auto_exposure = AutoExposureSpec{.target = random.uniform(0.12, 0.25),
                                               .lag_s = random.uniform(0.1, 0.6),
                                               .min_gain = 0.25,
                                               .max_gain = random.uniform(4.0, 16.0)};
      break;
    case Effect::SensorNoise:
      effects.sensor_noise = SensorNoiseSpec{.full_well = random.uniform(2000.0, 12000.0),
                                             .read = random.uniform(2.0, 8.0),
                                             .seed = any_seed(random)};
      break;
    case Effect::Reflection:
      effects.reflection = OpticsSpec{.depth = 2};
      break;
    case Effect::Refraction:
      effects.refraction = OpticsSpec{.depth = 4};
      break;
    case Effect::MovingSubject:
      effects.moving_subjects.push_back({subject,
                                         scene.subject_center,
                                         {.position_mm = random.uniform(1.0, 5.0),
                                          .rotation_deg = random.uniform(0.5, 3.0),
                                          .min_hz = 0.1,
                                          .max_hz = 0.6,
                                          .seed = any_seed(random)}});
      break;
    case Effect::PassingOccluder:
      effects.occluders.push_back(random_occluder(scene, random));
      break;
    case Effect::DroppedFrames:
      effects.dropped_frames = DroppedFramesSpec{.share = random.uniform(0.01, 0.04),
                                                 .burst = 1 + random.below(4),
                                                 .seed = any_seed(random)};
      break;
  }
}

}  // namespace

void add_random_effects(const std::set<Effect>& effects, const std::vector<std::string>& subject,
                        SceneSpec& scene, Random& random) {
  const std::uint64_t seed = random.bits();
  for (const Effect effect : effects) {
    // A stream for each: what one draws does not change with its company.
    Random own(scramble(seed ^ static_cast<std::uint64_t>(effect)));
    add_effect(effect, subject, scene, own);
  }
}

}  // namespace lumibox::hal::sim
