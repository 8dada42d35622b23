#include "hal/sim/random_scene.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

#include "config/error.h"
#include "geometry/camera.h"
#include "geometry/rotation.h"
#include "hal/sim/hand_path.h"
#include "hal/sim/random_objects.h"

// No picture is rendered here: what makes a scene one that could be filmed, over many seeds.
namespace lumibox::hal::sim {
namespace {

constexpr std::uint64_t kSeeds = 200;
constexpr double kDegrees = 180.0 / std::numbers::pi;

std::vector<RandomSceneOptions> all_kinds(std::uint64_t seed) {
  std::vector<RandomSceneOptions> kinds;
  for (std::size_t place = 0; place < kPlaceNames.size(); ++place) {
    for (std::size_t walk = 0; walk < kWalkNames.size(); ++walk) {
      RandomSceneOptions options{seed, static_cast<Place>(place), static_cast<Walk>(walk), {}};
      if (options.place == Place::Facade && options.walk == Walk::Orbit) continue;
      kinds.push_back(options);
    }
  }
  return kinds;
}

/// One of the kinds for each seed, all of them in turn.
RandomSceneOptions kind_of(std::uint64_t seed) {
  const auto kinds = all_kinds(seed);
  return kinds[seed % kinds.size()];
}

/// All that makes two scenes differ, to the last bit.
std::string fingerprint(const SceneSpec& scene) {
  std::ostringstream out;
  out << std::hexfloat << scene.duration_s << scene.background.transpose() << scene.camera.fx
      << scene.camera.k1 << scene.camera.readout_s << scene.subject_center.transpose()
      << scene.subject_radius_m;
  for (const TextureSpec& texture : scene.textures) {
    out << texture.name << static_cast<int>(texture.pattern) << texture.tile_m.transpose()
        << texture.cell_m << texture.grain << texture.seed;
    for (const Color& color : texture.palette) out << color.transpose();
  }
  for (const ObjectSpec& object : scene.objects) {
    out << object.name << object.size.transpose() << object.displacement.seed << object.texture
        << object.world_from_object.translation.transpose()
        << object.world_from_object.rotation.coeffs().transpose();
  }
  for (const LightSpec& light : scene.lights) {
    out << light.color.transpose() << light.direction.transpose() << light.position.transpose();
  }
  for (const KeyPose& key : scene.path.keys) out << key.position.transpose();
  out << scene.path.tremor.seed << scene.path.lead_in_m;
  return out.str();
}

TEST(RandomScene, BelongsToItsSeed) {
  std::set<std::string> seen;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    RandomSceneOptions options{seed, {}, {}, {Effect::LensDistortion, Effect::RollingShutter}};
    const std::string scene = fingerprint(random_scene(options));
    EXPECT_EQ(scene, fingerprint(random_scene(options))) << seed;
    seen.insert(scene);
  }
  EXPECT_EQ(seen.size(), kSeeds);
}

TEST(RandomScene, WalkAndEffectsDoNotChangeTheSubject) {
  const SceneSpec plain = random_scene({7, Place::Desk, Walk::Arc, {}});
  const SceneSpec other = random_scene({7, Place::Desk, Walk::Orbit, {Effect::SensorNoise}});
  EXPECT_EQ(plain.subject_radius_m, other.subject_radius_m);
  EXPECT_EQ(plain.camera.fx, other.camera.fx);
  EXPECT_EQ(plain.textures.front().seed, other.textures.front().seed);
}

TEST(RandomScene, HasWhatItsPartsReferTo) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const SceneSpec scene = random_scene(kind_of(seed));
    std::set<std::string> textures{""};
    for (const TextureSpec& texture : scene.textures) {
      EXPECT_TRUE(textures.insert(texture.name).second) << seed << ": twice " << texture.name;
      EXPECT_TRUE(std::has_single_bit(static_cast<unsigned>(texture.texels_x))) << texture.name;
      EXPECT_TRUE(std::has_single_bit(static_cast<unsigned>(texture.texels_y))) << texture.name;
      EXPECT_LE(texture.tile_m.maxCoeff(), 400.0 * texture.cell_m) << texture.name;
      for (const Color& color : texture.palette) {
        EXPECT_GE(color.minCoeff(), 0.0f) << texture.name;
        EXPECT_LE(color.maxCoeff(), 1.0f) << texture.name;
      }
    }
    std::set<std::string> objects;
    for (const ObjectSpec& object : scene.objects) {
      EXPECT_TRUE(objects.insert(object.name).second) << seed << ": twice " << object.name;
      EXPECT_TRUE(textures.contains(object.texture)) << seed << ": no " << object.texture;
      EXPECT_GT(object.size.head<2>().minCoeff(), 0.0) << object.name;
      EXPECT_TRUE(object.mirror == 0.0 || scene.effects.reflection) << seed;
      EXPECT_TRUE(!object.glass_ior || scene.effects.refraction) << seed;
    }
  }
}

/// The wall or ground between a point and the inside of the place, none if there is none.
bool is_behind(const ObjectSpec& object, const Eigen::Vector3d& point) {
  constexpr double kClearance_m = 0.1;
  return object.shape == Shape::Quad &&
         (object.world_from_object.inverse() * point).z() < kClearance_m;
}

bool is_inside(const ObjectSpec& object, const Eigen::Vector3d& point) {
  constexpr double kClearance_m = 0.04;
  if (object.shape == Shape::Quad) return false;
  const Eigen::Vector3d local = object.world_from_object.inverse() * point;
  if (object.shape == Shape::Box) {
    return (local.cwiseAbs() - 0.5 * object.size).maxCoeff() < kClearance_m;
  }
  return local.norm() < bounding_radius(object) + kClearance_m;
}

TEST(RandomScene, CameraStaysInTheOpenWithTheSubjectInView) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RandomSceneOptions options = kind_of(seed);
    const SceneSpec scene = random_scene(options);
    const HandPath path(scene.path, scene.duration_s);
    const geometry::Camera camera(scene.camera);
    for (double t = 0.0; t < scene.duration_s; t += 0.1) {
      const geometry::Pose pose = path.world_from_camera(t);
      for (const ObjectSpec& object : scene.objects) {
        ASSERT_FALSE(is_inside(object, pose.translation)) << seed << " " << object.name;
        ASSERT_FALSE(is_behind(object, pose.translation)) << seed << " " << object.name;
      }
      if (options.walk == Walk::Turn || options.walk == Walk::Shake) continue;
      const auto pixel = camera.project(pose.inverse() * scene.subject_center);
      ASSERT_TRUE(pixel && camera.contains(*pixel, 100.0)) << seed << " at " << t;
    }
  }
}

TEST(RandomScene, OrbitComesBackToWhereItWas) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SceneSpec scene = random_scene({seed, Place::Can, Walk::Orbit, {}});
    scene.path.tremor = {};
    const HandPath path(scene.path, scene.duration_s);
    const Eigen::Vector3d last = path.world_from_camera(scene.duration_s).translation;
    double nearest = 1e9;
    for (double t = 0.0; t < 0.4 * scene.duration_s; t += 0.02) {
      nearest = std::min(nearest, (path.world_from_camera(t).translation - last).norm());
    }
    const double radius = (last - scene.subject_center).norm();
    // Smoothing cuts the corner of a start from rest by a little.
    EXPECT_LT(nearest, 0.01 * radius) << seed;
  }
}

TEST(RandomScene, TurnIsWithoutTranslation) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SceneSpec scene = random_scene({seed, Place::Desk, Walk::Turn, {}});
    scene.path.tremor = {};
    const HandPath path(scene.path, scene.duration_s);
    constexpr double kStep_s = 0.02;
    double turned = 0.0;
    for (double t = 1.0; t < scene.duration_s - 1.0; t += kStep_s) {
      const geometry::Pose from = path.world_from_camera(t);
      const geometry::Pose to = path.world_from_camera(t + kStep_s);
      if ((to.translation - from.translation).norm() > 1e-9) continue;
      turned += geometry::log_so3(from.rotation.conjugate() * to.rotation).norm() * kDegrees;
    }
    // There and back; the smoothing of the path takes up to a tenth off its farthest point.
    EXPECT_GT(turned, 0.9 * 2.0 * 36.0) << seed;
    EXPECT_LT(turned, 2.0 * 44.5) << seed;
  }
}

TEST(RandomScene, ShakeIsInTheMiddle) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const SceneSpec scene = random_scene({seed, Place::Desk, Walk::Shake, {}});
    ASSERT_TRUE(scene.path.shake);
    EXPECT_EQ(scene.path.shake->duration_s, 0.5);
    EXPECT_GT(scene.path.shake->start_s, 0.3 * scene.duration_s);
    EXPECT_LT(scene.path.shake->start_s, 0.7 * scene.duration_s);
  }
  EXPECT_FALSE(random_scene({1, Place::Desk, Walk::Arc, {}}).path.shake);
}

/// Which effects a scene has, and with which its camera is described.
std::set<Effect> effects_of(const SceneSpec& scene) {
  const EffectSpecs& effects = scene.effects;
  std::set<Effect> found;
  const auto note = [&](bool present, Effect effect) {
    if (present) found.insert(effect);
  };
  note(effects.lens_distortion.has_value(), Effect::LensDistortion);
  note(scene.camera.k1 != 0.0 || scene.camera.k2 != 0.0, Effect::LensDistortion);
  note(effects.rolling_shutter.has_value(), Effect::RollingShutter);
  note(scene.camera.readout_s != 0.0, Effect::RollingShutter);
  note(effects.motion_blur.has_value(), Effect::MotionBlur);
  note(effects.vignetting.has_value(), Effect::Vignetting);
  note(effects.auto_exposure.has_value(), Effect::AutoExposure);
  note(effects.sensor_noise.has_value(), Effect::SensorNoise);
  note(effects.reflection.has_value(), Effect::Reflection);
  note(effects.refraction.has_value(), Effect::Refraction);
  note(!effects.moving_subjects.empty(), Effect::MovingSubject);
  note(!effects.occluders.empty(), Effect::PassingOccluder);
  note(effects.dropped_frames.has_value(), Effect::DroppedFrames);
  for (const ObjectSpec& object : scene.objects) {
    note(object.mirror > 0.0, Effect::Reflection);
    note(object.glass_ior.has_value(), Effect::Refraction);
  }
  return found;
}

TEST(RandomScene, HasTheNamedEffectsAndNoOthers) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const auto effect = static_cast<Effect>(seed % kEffectNames.size());
    EXPECT_EQ(effects_of(random_scene({seed, Place::Desk, {}, {effect}})), std::set{effect})
        << seed;
    for (const Place place : {Place::Desk, Place::Can, Place::Facade}) {
      EXPECT_TRUE(effects_of(random_scene({seed, place, {}, {}})).empty()) << seed;
    }
    EXPECT_EQ(effects_of(random_scene({seed, Place::Glass, {}, {}})), std::set{Effect::Refraction});
    EXPECT_EQ(effects_of(random_scene({seed, Place::Mirror, {}, {}})),
              std::set{Effect::Reflection});
  }
}

TEST(RandomScene, MirrorsAndGlassStandInScenesWithTheirEffects) {
  int mirrors = 0;
  int glasses = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const SceneSpec scene =
        random_scene({seed, Place::Desk, {}, {Effect::Reflection, Effect::Refraction}});
    for (const ObjectSpec& object : scene.objects) {
      if (object.mirror > 0.0) ++mirrors;
      if (object.glass_ior) ++glasses;
    }
  }
  EXPECT_EQ(mirrors, kSeeds);
  EXPECT_EQ(glasses, kSeeds);
}

TEST(RandomScene, LensShowsSomethingInEveryPixel) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const geometry::Camera camera(random_scene({seed, {}, {}, {Effect::LensDistortion}}).camera);
    for (const double x : {0.0, 320.0, 639.0}) {
      for (const double y : {0.0, 240.0, 479.0}) {
        EXPECT_TRUE(camera.unproject({x, y})) << seed << ": " << x << ", " << y;
      }
    }
  }
}

TEST(RandomScene, OccluderPassesBeforeTheSubject) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const SceneSpec scene = random_scene({seed, Place::Desk, Walk::Arc, {Effect::PassingOccluder}});
    const OccluderSpec& occluder = scene.effects.occluders.front();
    EXPECT_GT(occluder.start_s, 0.0) << seed;
    EXPECT_LT(occluder.start_s + occluder.duration_s, scene.duration_s) << seed;
    const HandPath path(scene.path, scene.duration_s);
    const double middle_s = occluder.start_s + 0.5 * occluder.duration_s;
    const Eigen::Vector3d eye = path.world_from_camera(middle_s).translation;
    const Eigen::Vector3d middle = 0.5 * (occluder.from + occluder.to);
    const Eigen::Vector3d sight = (scene.subject_center - eye).normalized();
    const double off = (middle - eye).cross(sight).norm();
    EXPECT_LT(off, 0.5 * occluder.size.minCoeff()) << seed;
    EXPECT_GT((middle - eye).norm(), 0.5 * occluder.size.maxCoeff() + 0.02) << seed;
  }
}

TEST(RandomScene, FacadeIsNotForEveryWalkOrEffect) {
  EXPECT_THROW(random_scene({1, Place::Facade, Walk::Orbit, {}}), config::InputError);
  EXPECT_THROW(random_scene({1, Place::Facade, {}, {Effect::Reflection}}), config::InputError);
  EXPECT_THROW(random_scene({1, Place::Facade, {}, {Effect::MovingSubject}}), config::InputError);
}

}  // namespace
}  // namespace lumibox::hal::sim
