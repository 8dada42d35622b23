#pragma once

#include <vector>

#include "hal/sim/checked_table.h"
#include "hal/sim/scene_spec.h"

namespace lumibox::hal::sim {

/// The keys of an oscillation; `fallback` gives the frequencies.
WobbleSpec read_wobble(CheckedTable& table, const WobbleSpec& fallback);

/// All [[effects]]. Lens and shutter go into `camera` as well: they are what a calibration tells.
EffectSpecs read_effects(CheckedTable& root, config::CameraProfile& camera);

/// Refuses names of textures and objects that do not exist or exist twice, and mirrors and glass
/// without their effect. `objects` are the tables of scene.objects, for the line numbers.
void check_references(const SceneSpec& scene, const CheckedTable& root,
                      const std::vector<CheckedTable>& objects);

}  // namespace lumibox::hal::sim
