#pragma once

#include <filesystem>
#include <string>

namespace lumibox::lightfield {

/// Throws config::InputError with the path, `what` and the system's words for `error`.
[[noreturn]] void fail_at(const std::filesystem::path& path, const std::string& what, int error);

/// An open file descriptor that closes itself.
class FileDescriptor {
 public:
  /// As open(2). Throws config::InputError if that fails, which calls the file `name`.
  FileDescriptor(const std::filesystem::path& path, int flags, const std::filesystem::path& name);
  ~FileDescriptor();
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;

  int get() const { return value_; }

 private:
  int value_;
};

}  // namespace lumibox::lightfield
