#pragma once

#include <filesystem>

namespace lumibox::hal {

/// Throws config::InputError unless `folder` can become something new: nothing is there, or an
/// empty folder. Nothing recorded is ever overwritten.
void require_new_folder(const std::filesystem::path& folder);

}  // namespace lumibox::hal
