#pragma once

#include <filesystem>
#include <string>

namespace lumibox::lightfield {

/// Throws config::InputError with the path, `what` and the system's words for `error`.
[[noreturn]] void fail_at(const std::filesystem::path& path, const std::string& what, int error);

/// An open file descriptor that closes itself.
class Descriptor {
 public:
  /// As open(2). Throws config::InputError if that fails, which calls the file `name`.
  Descriptor(const std::filesystem::path& path, int flags, const std::filesystem::path& name);
  ~Descriptor();
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return value_; }

 private:
  int value_;
};

}  // namespace lumibox::lightfield
