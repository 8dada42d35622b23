#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "config/config.h"
#include "config/loader.h"

namespace lumibox::app {

/// Each adds one subcommand that does its work when the command line names it. Bad input throws
/// config::InputError.
void add_run(CLI::App& app);
void add_demo(CLI::App& app);
void add_track(CLI::App& app);
void add_render(CLI::App& app);
void add_evaluate(CLI::App& app);
void add_import(CLI::App& app);
void add_export(CLI::App& app);
void add_sim(CLI::App& app);

/// A subcommand with the options that all have (--config, --set), which end up in `sources`, and an
/// example in its help.
CLI::App* add_command(CLI::App& app, const char* name, const char* description, const char* example,
                      config::Sources& sources);

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
