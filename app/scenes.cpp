#include "app/scenes.h"

#include <array>

#include "config/error.h"

namespace lumibox::app {

std::filesystem::path find_scene(const std::string& name) {
  const std::array<std::filesystem::path, 2> folders = {LUMIBOX_INSTALLED_SCENES,
                                                        LUMIBOX_SOURCE_SCENES};
  for (const std::filesystem::path& folder : folders) {
    std::error_code ignored;
    if (auto file = folder / (name + ".toml"); std::filesystem::exists(file, ignored)) {
      return file;
    }
  }
  throw config::InputError(
      folders.front() / (name + ".toml"),
      "not found, nor in " + folders.back().string() + "; is Lumibox installed whole?");
}

}  // namespace lumibox::app
