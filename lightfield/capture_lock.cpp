#include "lightfield/capture_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <map>
#include <mutex>
#include <utility>

#include "hal/new_folder.h"
#include "lightfield/file_descriptor.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;

using FolderId = std::pair<dev_t, ino_t>;

FolderId id_of(const FileDescriptor& folder, const fs::path& path) {
  struct stat status {};
  if (::fstat(folder.get(), &status) != 0) fail_at(path, "cannot be read", errno);
  return {status.st_dev, status.st_ino};
}

/// The folders that this process has locked. The system would have it lock itself out where it
/// opens a folder twice.
class LockedFolders {
 public:
  FolderId add(const fs::path& path) {
    auto folder = std::make_unique<const FileDescriptor>(path, O_RDONLY | O_DIRECTORY, path);
    const FolderId id = id_of(*folder, path);
    const std::lock_guard guard(mutex_);
    Locked& locked = locked_[id];
    if (locked.shares == 0) {
      if (::flock(folder->get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        locked_.erase(id);
        throw CaptureInUse(path);
      }
      locked.folder = std::move(folder);
    }
    ++locked.shares;
    return id;
  }

  void remove(const FolderId& id) {
    const std::lock_guard guard(mutex_);
    const auto found = locked_.find(id);
    if (--found->second.shares == 0) locked_.erase(found);
  }

 private:
  struct Locked {
    std::unique_ptr<const FileDescriptor> folder;
    int shares = 0;
  };

  std::mutex mutex_;
  std::map<FolderId, Locked> locked_;
};

LockedFolders& locked_folders() {
  static LockedFolders folders;
  return folders;
}

/// One who holds a folder's lock.
class Share {
 public:
  explicit Share(const fs::path& folder) : id_(locked_folders().add(folder)) {}
  ~Share() { locked_folders().remove(id_); }
  Share(const Share&) = delete;
  Share& operator=(const Share&) = delete;

 private:
  FolderId id_;
};

}  // namespace

CaptureLock::CaptureLock(const fs::path& folder) : share_(std::make_shared<const Share>(folder)) {}

CaptureLock make_capture_folder(const DurableFiles& files, const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) make_new_folder(files, folder);
  CaptureLock lock(folder);
  hal::require_new_folder(folder);  // by now it may be another's
  return lock;
}

}  // namespace lumibox::lightfield
