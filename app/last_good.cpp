#include "app/last_good.h"

#include "app/commands/support.h"
#include "config/error.h"
#include "config/input_file.h"
#include "config/log.h"
#include "lightfield/durable_files.h"

namespace lumibox::app {
namespace {

OpenBox open_as_configured(const config::Sources& sources) {
  const config::Config config = load_config(sources);
  return {config, open_devices(config), std::nullopt};
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

void keep_last_good(const std::filesystem::path& file, const std::filesystem::path& last_good) {
  try {
    const std::string text = config::read_text(file);
    if (!config::fault_of_file(last_good) && config::read_text(last_good) == text) return;
    lightfield::DurableFiles().write(last_good, text);
  } catch (const config::InputError& error) {
    config::log_warning(std::string("the settings are not kept as the last good ones: ") +
                        error.what());
  }
}

}  // namespace lumibox::app
