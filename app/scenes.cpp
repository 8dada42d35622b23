#include "app/scenes.h"

#include <algorithm>
#include <array>

#include "config/error.h"

namespace lumibox::app {

namespace {

const std::array<std::filesystem::path, 2> kFolders = {LUMIBOX_INSTALLED_SCENES,
                                                       LUMIBOX_SOURCE_SCENES};

[[noreturn]] void complain(const std::string& file) {
  throw config::InputError(
      kFolders.front() / file,
      "not found, nor in " + kFolders.back().string() + "; is Lumibox installed whole?");
}

}  // namespace

std::filesystem::path find_scene(const std::string& name) {
  for (const std::filesystem::path& folder : kFolders) {
    std::error_code ignored;
    if (auto file = folder / (name + ".toml"); std::filesystem::exists(file, ignored)) {
      return file;
    }
  }
  complain(name + ".toml");
}

std::vector<std::string> scene_names() {
  for (const std::filesystem::path& folder : kFolders) {
    std::error_code ignored;
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
      if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    }
    std::ranges::sort(names);
    if (!names.empty()) return names;
  }
  complain("*.toml");
}

}  // namespace lumibox::app
