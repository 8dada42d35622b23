#pragma once

#include <filesystem>

#include "hal/sim/scene_spec.h"

namespace lumibox::hal::sim {

/// Reads and checks a scene file. Throws config::InputError with file, line, key and what is
/// allowed.
SceneSpec read_scene_file(const std::filesystem::path& file);

}  // namespace lumibox::hal::sim
