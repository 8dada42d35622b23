#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace lumibox::config {

/// Writes a file, in place of what it held. Throws InputError with the path and the system's reason
/// if it cannot; a file that would be cut short is removed.
void write_bytes(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace lumibox::config
