#include "hal/sim/random_scene.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "config/error.h"
#include "hal/sim/random_effects.h"
#include "hal/sim/random_objects.h"
#include "hal/sim/random_walk.h"

namespace lumibox::hal::sim {
namespace {

/// Parts of a scene are drawn from streams of their own: the same desk can be walked differently.
enum class Part : std::uint64_t { Choice, Subject, Camera, Walk, Surroundings, Lights, Effects };

Random stream(std::uint64_t seed, Part part) {
  return Random(scramble(seed) ^ scramble(static_cast<std::uint64_t>(part)));
}

config::CameraProfile random_camera(Random& random) {
  config::CameraProfile camera;
  camera.width = 640;
  camera.height = 480;
  camera.fps = 30.0;
  const double field = random.uniform(50.0, 75.0) * std::numbers::pi / 180.0;
  camera.fx = 0.5 * camera.width / std::tan(0.5 * field);
  camera.fy = camera.fx * random.uniform(0.997, 1.003);
  camera.cx = 0.5 * (camera.width - 1) + random.uniform(-8.0, 8.0);
  camera.cy = 0.5 * (camera.height - 1) + random.uniform(-8.0, 8.0);
  return camera;
}

/// Between a cool and a warm white.
Color random_white(Random& random) {
  const auto warmth = static_cast<float>(random.uniform(-0.12, 0.2));
  return {std::min(1.0f, 1.0f + warmth), 0.97f, std::min(1.0f, 1.0f - warmth)};
}

/// The sky or the room, the sun or a window, and perhaps a lamp.
void add_lights(Place place, SceneSpec& scene, Random& random) {
  LightSpec ambient;
  ambient.kind = LightKind::Ambient;
  ambient.color = random_white(random) * static_cast<float>(random.uniform(0.35, 0.7));
  ambient.reach_m = place == Place::Facade ? 4.0 : 0.3;
  ambient.shadows = Shadows::Baked;
  LightSpec sun;
  sun.kind = LightKind::Directional;
  sun.color = random_white(random) * static_cast<float>(random.uniform(0.3, 0.8));
  const double steepness = random.uniform(0.6, 1.6);
  const double angle = random.uniform(-std::numbers::pi, std::numbers::pi);
  // A facade in its own shadow would be dull.
  const double y = place == Place::Facade ? std::abs(std::cos(angle)) + 0.2 : std::cos(angle);
  sun.direction = Eigen::Vector3d(std::sin(angle), y, -steepness).normalized();
  sun.softness_deg = random.uniform(0.5, 8.0);
  sun.shadows = Shadows::Baked;
  scene.lights = {ambient, sun};
  if (place == Place::Facade || random.uniform() < 0.5) return;
  LightSpec lamp;
  lamp.kind = LightKind::Point;
  lamp.color = random_white(random) * static_cast<float>(random.uniform(0.2, 0.5));
  lamp.position = {random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2), random.uniform(0.9, 1.6)};
  lamp.falloff_m = 1.2;
  lamp.shadows = Shadows::None;
  scene.lights.push_back(lamp);
}

/// How many things lie about.
int random_clutter(Place place, Random& random) {
  if (place == Place::Can) return std::max(0, random.below(5) - 2);
  return 3 + random.below(8);
}

void refuse_what_a_facade_lacks(const RandomSceneOptions& options, Walk walk) {
  if (walk == Walk::Orbit) {
    throw config::InputError("a random scene: a facade cannot be walked around");
  }
  for (const Effect effect : {Effect::Reflection, Effect::Refraction, Effect::MovingSubject}) {
    if (options.effects.contains(effect)) {
      throw config::InputError("a random scene: a facade has nothing for the effect " +
                               std::string(kEffectNames[static_cast<std::size_t>(effect)]));
    }
  }
}

}  // namespace

SceneSpec random_scene(const RandomSceneOptions& options) {
  Random choice = stream(options.seed, Part::Choice);
  const auto any_place = static_cast<Place>(choice.below(static_cast<int>(kPlaceNames.size())));
  const auto any_walk = static_cast<Walk>(choice.below(static_cast<int>(kWalkNames.size())));
  const Place place = options.place.value_or(any_place);
  const bool stands_free = place != Place::Facade || options.walk || any_walk != Walk::Orbit;
  const Walk walk = options.walk.value_or(stands_free ? any_walk : Walk::Arc);
  if (place == Place::Facade) refuse_what_a_facade_lacks(options, walk);

  SceneSpec scene;
  Random camera = stream(options.seed, Part::Camera);
  scene.camera = random_camera(camera);
  Random subject = stream(options.seed, Part::Subject);
  const WalkRoom room = add_subject(place, scene, subject);
  std::vector<std::string> subject_names;
  for (const ObjectSpec& object : scene.objects) subject_names.push_back(object.name);

  Random hand = stream(options.seed, Part::Walk);
  const RandomWalk chosen = random_walk(walk, room, hand);
  scene.path = chosen.path;
  scene.duration_s = chosen.duration_s;

  std::set<Effect> effects = options.effects;
  if (place == Place::Glass) effects.insert(Effect::Refraction);
  if (place == Place::Mirror) effects.insert(Effect::Reflection);
  Random disturbances = stream(options.seed, Part::Effects);
  add_random_effects(effects, subject_names, scene, disturbances);

  Random things = stream(options.seed, Part::Surroundings);
  add_surroundings(place, room, scene, things);
  if (place != Place::Facade) {
    const bool optics =
        effects.contains(Effect::Reflection) || effects.contains(Effect::Refraction);
    add_clutter(random_clutter(place, things) + (optics ? 2 : 0), scene, things);
  }
  Random lights = stream(options.seed, Part::Lights);
  add_lights(place, scene, lights);
  return scene;
}

}  // namespace lumibox::hal::sim
