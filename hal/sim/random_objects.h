#pragma once

#include <Eigen/Geometry>

#include "hal/sim/random.h"
#include "hal/sim/random_scene.h"
#include "hal/sim/random_walk.h"

namespace lumibox::hal::sim {

/// Puts what the walk goes around into the scene, sets its sphere, and says where one may walk.
WalkRoom add_subject(Place place, SceneSpec& scene, Random& random);

/// Floor, desk, walls, street: what the place has and a walk within its room never meets.
void add_surroundings(Place place, const WalkRoom& room, SceneSpec& scene, Random& random);

/// Puts more things around the subject, at most `count`: none that touches another, that the
/// scene's path comes near, or that hides the subject for long. They are boxes, balls, mugs, rings;
/// the first is a mirror ball with the effect reflection, the next one of glass with refraction.
void add_clutter(int count, SceneSpec& scene, Random& random);

/// Upright objects turn about z; radians.
Eigen::Quaterniond about_z(double angle);

/// Radius of an upright cylinder about an object's origin that holds all of it; turns about z only.
double footprint(const ObjectSpec& object);

/// Radius of a sphere around an object's origin that holds all of it.
double bounding_radius(const ObjectSpec& object);

}  // namespace lumibox::hal::sim
