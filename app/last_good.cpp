#include "app/last_good.h"

#include <system_error>
#include <utility>

#include "app/commands/recorded.h"
#include "app/commands/support.h"
#include "config/error.h"
#include "config/input_file.h"
#include "config/log.h"
#include "lightfield/durable_files.h"

namespace lumibox::app {
namespace {

OpenBox open_as_configured(const config::Sources& sources) {
  // The file may be another by the time that they have been seen to work.
  std::string settings = sources.file ? config::read_text(*sources.file) : std::string();
  const config::Config config = load_config(sources);
  make_folder(config.capture.folder);
  return {config, open_devices(config), std::move(settings), std::nullopt};
}

/// On the file `good` in place of that of `sources`, which is not used because of the problem.
OpenBox open_on_last_good(config::Sources sources, const std::filesystem::path& good,
                          const std::string& problem) {
  config::log_error(problem + "; trying the last good settings, " + good.string());
  sources.file = good;
  OpenBox box = open_as_configured(sources);
  box.problem = problem;
  return box;
}

/// A device that is missing may be one that only the new settings name.
std::optional<OpenBox> open_without_waiting(const config::Sources& sources,
                                            const std::filesystem::path& good,
                                            const std::string& problem) {
  try {
    OpenBox box = open_on_last_good(sources, good, problem);
    if (box.devices.missing.empty()) return box;
    config::log_error("the last good settings will not do either: " + box.devices.missing);
  } catch (const config::InputError& error) {
    config::log_error(std::string("the last good settings will not do either: ") + error.what());
  }
  return std::nullopt;
}

}  // namespace

OpenBox open_box(const config::Sources& sources,
                 const std::optional<std::filesystem::path>& last_good) {
  const bool has_last_good = last_good && !config::fault_of_file(*last_good);
  std::optional<OpenBox> box;
  try {
    box.emplace(open_as_configured(sources));
  } catch (const config::InputError& error) {
    if (!has_last_good) throw;
    return open_on_last_good(sources, *last_good, error.what());
  }
  const std::string missing = box->devices.missing;
  if (missing.empty() || !has_last_good || config::read_text(*last_good) == box->settings) {
    return std::move(*box);
  }
  box.reset();  // no device is opened twice
  if (auto good = open_without_waiting(sources, *last_good, missing)) return std::move(*good);
  return open_as_configured(sources);
}

void check_last_good(const std::filesystem::path& last_good) {
  refuse_recorded(last_good);
  std::error_code error;
  const auto status = std::filesystem::symlink_status(last_good, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw config::InputError(last_good, "is no file; expected one for the last good settings");
  }
}

void keep_last_good(const std::string& settings, const std::filesystem::path& last_good) {
  try {
    if (!config::fault_of_file(last_good) && config::read_text(last_good) == settings) return;
    lightfield::DurableFiles().write(last_good, settings);
  } catch (const config::InputError& error) {
    config::log_warning(std::string("the settings are not kept as the last good ones: ") +
                        error.what());
  }
}

}  // namespace lumibox::app
