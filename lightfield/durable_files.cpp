#include "lightfield/durable_files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "hal/new_folder.h"
#include "lightfield/file_descriptor.h"

namespace lumibox::lightfield {

namespace fs = std::filesystem;

void DurableFiles::write_and_sync(const fs::path& aside, const fs::path& path,
                                  std::span<const std::uint8_t> bytes) const {
  const FileDescriptor file(aside, O_WRONLY | O_CREAT | O_TRUNC, path);
  note(Step::Opened, aside);
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_at(path, "cannot write", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  note(Step::Written, aside);
  if (::fsync(file.get()) != 0) fail_at(path, "cannot write", errno);
  note(Step::FileSynced, aside);
}

void DurableFiles::write(const fs::path& path, std::span<const std::uint8_t> bytes) const {
  fs::path aside = path;
  aside += ".tmp";
  try {
    write_and_sync(aside, path, bytes);
    if (::rename(aside.c_str(), path.c_str()) != 0) fail_at(path, "cannot rename to it", errno);
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
  const FileDescriptor descriptor(folder, O_RDONLY | O_DIRECTORY, folder);
  // EINVAL: a file system that has nothing to sync there, e.g. some network mounts.
  if (::fsync(descriptor.get()) != 0 && errno != EINVAL) fail_at(folder, "cannot sync", errno);
  note(Step::FolderSynced, folder);
}

void DurableFiles::make_folder(const fs::path& path) const {
  std::error_code error;
  if (fs::is_directory(path, error)) return;
  const fs::path parent = path.parent_path();
  if (!parent.empty() && parent != path) make_folder(parent);
  if (!fs::create_directory(path, error) && error)
    fail_at(path, "cannot make folder", error.value());
  note(Step::FolderMade, path);
  sync_folder(parent);
}

void DurableFiles::remove(const fs::path& path) const {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) fail_at(path, "cannot remove", errno);
  note(Step::Removed, path);
}

void make_new_folder(const DurableFiles& files, const fs::path& folder) {
  hal::require_new_folder(folder);
  files.make_folder(folder);
}

}  // namespace lumibox::lightfield
