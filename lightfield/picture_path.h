#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lumibox::lightfield {

/// True if `path` names something below the folder it is relative to: not absolute, no way out by
/// "..". A data set from elsewhere must not reach for files outside it.
bool stays_inside(const std::string& path);

/// Throws config::InputError that names `file` and lists the pictures it speaks of that do not
/// exist in `folder`.
void require_pictures(const std::filesystem::path& file, const std::filesystem::path& folder,
                      const std::vector<std::string>& pictures);

}  // namespace lumibox::lightfield
