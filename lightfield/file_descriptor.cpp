#include "lightfield/file_descriptor.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "config/error.h"

namespace lumibox::lightfield {

void fail_at(const std::filesystem::path& path, const std::string& what, int error) {
  throw config::InputError(path, what + ": " + std::generic_category().message(error));
}

FileDescriptor::FileDescriptor(const std::filesystem::path& path, int flags,
                               const std::filesystem::path& name)
    : value_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {
  if (value_ < 0) fail_at(name, "cannot open", errno);
}

FileDescriptor::~FileDescriptor() {
  ::close(value_);
}

}  // namespace lumibox::lightfield
