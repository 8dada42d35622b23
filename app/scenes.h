#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lumibox::app {

/// A scene that comes with the program, by name: where it is installed, else in the source tree.
/// Throws config::InputError if it is in neither.
std::filesystem::path find_scene(const std::string& name);

/// Names of all of them, in order. Throws as find_scene() if there are none.
std::vector<std::string> scene_names();

}  // namespace lumibox::app
