#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "config/config.h"
#include "config/loader.h"

namespace lumibox::app {

/// The configuration, with the log set to its level.
config::Config load_config(const config::Sources& sources);

/// Writes a JSON file and the folder it is in; throws config::InputError if it cannot.
void write_json(const std::filesystem::path& file, const nlohmann::json& json);

/// Makes the folder that a file is to be written into.
void make_parent_folder(const std::filesystem::path& file);

/// Throws config::InputError if the folder holds something already.
void refuse_used_folder(const std::filesystem::path& folder);

/// Makes a folder for results; throws config::InputError if it cannot be made.
void make_folder(const std::filesystem::path& folder);

}  // namespace lumibox::app
