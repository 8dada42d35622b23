#pragma once

#include <filesystem>
#include <string>

namespace lumibox::app {

/// A scene that comes with the program, by name: where it is installed, else in the source tree.
/// Throws config::InputError if it is in neither.
std::filesystem::path find_scene(const std::string& name);

}  // namespace lumibox::app
