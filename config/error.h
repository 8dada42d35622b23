#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace lumibox::config {

/// Something outside the program is wrong: a file, a device, an option. The message is one line for
/// a person: where (file and line, or device), what was found, what was expected. Caught once, in
/// main(), which prints it and exits with a non-zero status. Control characters, which come from
/// quoting what was found, are shown as '?'.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(one_line(message)) {}

  /// "path: message"
  InputError(const std::filesystem::path& file, const std::string& message)
      : InputError(file.string() + ": " + message) {}

  /// "path:line: message"; lines count from 1.
  InputError(const std::filesystem::path& file, int line, const std::string& message)
      : InputError(file.string() + ":" + std::to_string(line) + ": " + message) {}

 private:
  static std::string one_line(std::string message) {
    for (char& c : message) {
      if (static_cast<unsigned char>(c) < ' ') {
        c = '?';
      }
    }
    return message;
  }
};

/// A device is named, but is not there now, or not one that will do: it is unplugged, or another
/// program has it. That may pass: what can wait, waits for it.
class Unavailable : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace lumibox::config
