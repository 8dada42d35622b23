#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace lumibox::config {

/// Something outside the program is wrong: a file, a device, an option. The message is one line for
/// a person: where (file and line, or device), what was found, what was expected. Caught once, in
/// main(), which prints it and exits with a non-zero status.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}

  /// "path: message"
  InputError(const std::filesystem::path& file, const std::string& message)
      : std::runtime_error(file.string() + ": " + message) {}

  /// "path:line: message"; lines count from 1.
  InputError(const std::filesystem::path& file, int line, const std::string& message)
      : std::runtime_error(file.string() + ":" + std::to_string(line) + ": " + message) {}
};

}  // namespace lumibox::config
