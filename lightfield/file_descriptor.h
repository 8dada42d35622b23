#pragma once

#include <filesystem>
#include <string>

#include "hal/owned.h"

namespace lumibox::lightfield {

/// Throws config::InputError with the path, `what` and the system's words for `error`.
[[noreturn]] void fail_at(const std::filesystem::path& path, const std::string& what, int error);

/// An open file descriptor that closes itself.
class FileDescriptor {
 public:
  /// As open(2). Throws config::InputError if that fails, which calls the file `name`.
  FileDescriptor(const std::filesystem::path& path, int flags, const std::filesystem::path& name);

  int get() const { return file_.descriptor(); }

 private:
  hal::File file_;
};

}  // namespace lumibox::lightfield
