#pragma once

#include <string>
#include <string_view>

/// What is said about the work, to stderr; results go to stdout. Thin, so that only one file pays
/// for compiling spdlog.
namespace lumibox::config {

/// Says each message as one line with the program's name. Called once, before the first message.
void start_log();

/// Messages below `level` (debug, info, warn, error, off) are not said.
void set_log_level(const std::string& level);

void log_info(std::string_view message);
void log_warning(std::string_view message);
void log_error(std::string_view message);

}  // namespace lumibox::config
