#include "lightfield/durable_files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "config/error.h"
#include "hal/new_folder.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  throw config::InputError(path, what + ": " + std::generic_category().message(error));
}

/// An open file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : value_(::open(path.c_str(), flags, 0644)) {
    if (value_ < 0) fail(path, "cannot open", errno);
  }
  ~Descriptor() { ::close(value_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return value_; }

 private:
  int value_;
};

}  // namespace

void DurableFiles::write_and_sync(const fs::path& path, std::span<const std::uint8_t> bytes) const {
  const Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC);
  note(Step::Opened, path);
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, "cannot write", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  note(Step::Written, path);
  if (::fsync(file.get()) != 0) fail(path, "cannot write", errno);
  note(Step::FileSynced, path);
}

void DurableFiles::write(const fs::path& path, std::span<const std::uint8_t> bytes) const {
  fs::path aside = path;
  aside += ".tmp";
  try {
    write_and_sync(aside, bytes);
    if (::rename(aside.c_str(), path.c_str()) != 0) fail(path, "cannot rename to it", errno);
  } catch (...) {
    ::unlink(aside.c_str());
    throw;
  }
  note(Step::Renamed, path);
  sync_folder(path.parent_path());
}

void DurableFiles::write(const fs::path& path, std::string_view text) const {
  write(path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void DurableFiles::sync_folder(const fs::path& path) const {
  const fs::path folder = path.empty() ? fs::path(".") : path;
  const Descriptor descriptor(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  // EINVAL: a file system that has nothing to sync there, e.g. some network mounts.
  if (::fsync(descriptor.get()) != 0 && errno != EINVAL) fail(folder, "cannot sync", errno);
  note(Step::FolderSynced, folder);
}

void DurableFiles::make_folder(const fs::path& path) const {
  std::error_code error;
  if (fs::is_directory(path, error)) return;
  const fs::path parent = path.parent_path();
  if (!parent.empty() && parent != path) make_folder(parent);
  if (!fs::create_directory(path, error) && error) fail(path, "cannot make folder", error.value());
  note(Step::FolderMade, path);
  sync_folder(parent);
}

void DurableFiles::remove(const fs::path& path) const {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) fail(path, "cannot remove", errno);
  note(Step::Removed, path);
}

void make_new_folder(const DurableFiles& files, const fs::path& folder) {
  hal::require_new_folder(folder);
  files.make_folder(folder);
}

}  // namespace lumibox::lightfield
