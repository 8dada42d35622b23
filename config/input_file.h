#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lumibox::config {

/// Why there is no regular file of this name, e.g. "no such file" or "a folder, not a file"; none
/// if there is one.
std::optional<std::string> fault_of_file(const std::filesystem::path& file);

/// All of a regular file: anything else may block or never end. A file of more than a GiB is
/// refused: a sparse one costs its author nothing, and the memory of whoever reads it. Throws
/// InputError that names the file.
std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file);
std::string read_text(const std::filesystem::path& file);

}  // namespace lumibox::config
