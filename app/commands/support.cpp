#include "app/commands/support.h"

#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "config/error.h"
#include "config/error_text.h"
#include "config/log.h"
#include "config/output_file.h"
#include "lightfield/transforms.h"

namespace lumibox::app {

config::Config load_config(const config::Sources& sources) {
  config::Config config = config::load(sources);
  config::set_log_level(config.log.level);
  return config;
}

void require_writable(const std::filesystem::path& file) {
  make_parent_folder(file);
  std::error_code ignored;
  const bool is_there = std::filesystem::exists(file, ignored);
  errno = 0;
  if (!std::ofstream(file, std::ios::app)) {
    throw config::InputError(file, "cannot be written: " + config::error_text(errno));
  }
  if (!is_there) {
    std::filesystem::remove(file, ignored);
  }
}

void require_distinct(std::span<const std::filesystem::path> files) {
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& file : files) {
    std::error_code ignored;
    if (std::filesystem::is_character_file(file, ignored)) continue;
    if (!seen.insert(std::filesystem::weakly_canonical(file, ignored)).second) {
      throw config::InputError(file, "named for two results; expected a file for each");
    }
  }
}

const lightfield::Sphere& subject_of(const lightfield::Capture& capture) {
  if (!capture.light_field.subject()) {
    throw config::InputError(capture.folder / lightfield::kTransformsFile,
                             "names no subject; expected lumibox.subject");
  }
  return *capture.light_field.subject();
}

void require_all_pictures(const lightfield::Capture& capture) {
  if (const auto lost = capture.light_field.lost_pictures()) throw config::InputError(*lost);
}

void write_json(const std::filesystem::path& file, const nlohmann::json& json) {
  config::write_text(file, json.dump(2) + "\n");
}

void make_parent_folder(const std::filesystem::path& file) {
  if (file.has_parent_path()) {
    make_folder(file.parent_path());
  }
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw config::InputError(
        folder, "the folder cannot be made" + (error ? ": " + error.message() : std::string()));
  }
}

}  // namespace lumibox::app
