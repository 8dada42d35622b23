#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/devices.h"
#include "config/config.h"
#include "config/loader.h"

namespace lumibox::app {

/// A box that is configured and whose devices are open.
struct OpenBox {
  config::Config config;
  Devices devices;
  std::string settings;                ///< text of the file that they are from, if from one
  std::optional<std::string> problem;  ///< why it runs on the last good settings instead
};

/// As the sources say. If that is wrong, or the devices that it names cannot be opened, and there
/// is a file `last_good`, as that says in place of `sources.file`, and what was wrong is logged.
/// Throws config::InputError if neither will do. A camera or screen that is missing by either is
/// left to be waited for, as the sources say.
OpenBox open_box(const config::Sources& sources,
                 const std::optional<std::filesystem::path>& last_good);

/// Throws config::InputError if settings cannot be kept there: in a capture, or where something is
/// that is no file.
void check_last_good(const std::filesystem::path& last_good);

/// Keeps settings that the box has been seen to work with; they are there whole even if the power
/// goes meanwhile. A copy that cannot be written is a warning.
void keep_last_good(const std::string& settings, const std::filesystem::path& last_good);

}  // namespace lumibox::app
