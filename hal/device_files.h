#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace lumibox::hal {

/// The files in a folder of devices whose names begin with `prefix`, in order of their paths; none
/// if there is no such folder, as where nothing is plugged in. Devices may come and go meanwhile.
std::vector<std::filesystem::path> device_files(const std::filesystem::path& folder,
                                                std::string_view prefix = {});

}  // namespace lumibox::hal
