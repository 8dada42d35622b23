#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>

namespace lumibox::testing {

/// A folder locked as another process would: the system tells locks apart by who opened the folder,
/// not by the process. Does not wait if it is locked already.
class FolderOfAnother {
 public:
  explicit FolderOfAnother(const std::filesystem::path& folder)
      : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)),
        has_it_(folder_ >= 0 && ::flock(folder_, LOCK_EX | LOCK_NB) == 0) {}
  ~FolderOfAnother() {
    if (folder_ >= 0) ::close(folder_);
  }
  FolderOfAnother(const FolderOfAnother&) = delete;
  FolderOfAnother& operator=(const FolderOfAnother&) = delete;

  bool has_it() const { return has_it_; }

 private:
  int folder_;
  bool has_it_;
};

}  // namespace lumibox::testing
