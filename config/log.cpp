#include "config/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace lumibox::config {

void start_log() {
  spdlog::set_default_logger(spdlog::stderr_color_mt("lumibox"));
  spdlog::set_pattern("lumibox: %^%l%$: %v");
}

void set_log_level(const std::string& level) {
  spdlog::set_level(spdlog::level::from_str(level));
}

void log_info(std::string_view message) {
  spdlog::info(message);
}

void log_warning(std::string_view message) {
  spdlog::warn(message);
}

void log_error(std::string_view message) {
  spdlog::error(message);
}

}  // namespace lumibox::config
