#pragma once

#include <set>
#include <string>
#include <vector>

#include "hal/sim/random.h"
#include "hal/sim/scene_spec.h"

namespace lumibox::hal::sim {

/// Adds the effects to the scene, whose path must be there, with parameters as webcams and phones
/// have them; those of lens and shutter go into the camera as well. `subject` are the objects that
/// move with the effect moving_subject.
void add_random_effects(const std::set<Effect>& effects, const std::vector<std::string>& subject,
                        SceneSpec& scene, Random& random);

}  // namespace lumibox::hal::sim
