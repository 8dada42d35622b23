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
  return {config, open_devices(config), std::move(settings), std::nullopt};
}

}  // namespace

OpenBox open_box(const config::Sources& sources,
                 const std::optional<std::filesystem::path>& last_good) {
  try {
    return open_as_configured(sources);
  } catch (const config::InputError& error) {
    if (!last_good || config::fault_of_file(*last_good)) throw;
    config::log_error(std::string(error.what()) + "; trying the last good settings, " +
                      last_good->string());
    config::Sources good = sources;
    good.file = *last_good;
    OpenBox box = open_as_configured(good);
    box.problem = error.what();
    return box;
  }
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
