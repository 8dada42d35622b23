#include "lightfield/file_descriptor.h"

#include <fcntl.h>

#include <cerrno>

#include "config/error.h"
#include "config/error_text.h"

namespace lumibox::lightfield {

void fail_at(const std::filesystem::path& path, const std::string& what, int error) {
  throw config::InputError(path, what + ": " + config::error_text(error));
}

FileDescriptor::FileDescriptor(const std::filesystem::path& path, int flags,
                               const std::filesystem::path& name)
    : file_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {
  if (get() < 0) fail_at(name, "cannot open", errno);
}

}  // namespace lumibox::lightfield
