#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "config/config.h"
#include "config/loader.h"
#include "lightfield/capture.h"

namespace lumibox::app {

/// The configuration, with the log set to its level.
config::Config load_config(const config::Sources& sources);

/// Says before the work that a result of it can be written there, and makes the folder it will be
/// in; throws config::InputError if not. A file that is there keeps its content.
void require_writable(const std::filesystem::path& file);

/// Throws config::InputError if two of the files to be written are one. What is written to devices
/// (/dev/null) does not overwrite.
void require_distinct(std::span<const std::filesystem::path> files);

/// Writes a JSON file; throws config::InputError if it cannot.
void write_json(const std::filesystem::path& file, const nlohmann::json& json);

/// Makes the folder that a file is to be written into.
void make_parent_folder(const std::filesystem::path& file);

/// The capture's subject; throws config::InputError if it has none.
const lightfield::Sphere& subject_of(const lightfield::Capture& capture);

/// Throws config::InputError if a picture of the capture was lost since it was loaded: what was
/// made without it is not what was asked for.
void require_all_pictures(const lightfield::Capture& capture);

/// Makes a folder for results; throws config::InputError if it cannot be made.
void make_folder(const std::filesystem::path& folder);

}  // namespace lumibox::app
