#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <utility>

namespace lumibox::lightfield {

/// File operations that survive a power cut. A file appears under its name only when all its bytes
/// are on the disk, and once a call has returned its effect stays. All throw config::InputError
/// with the path and the system's reason.
class DurableFiles {
 public:
  enum class Step { Opened, Written, FileSynced, Renamed, FolderSynced, FolderMade, Removed };

  /// Called after every single operation of the file system with the path it was done to, so that a
  /// test can stop the world in between.
  using Observer = std::function<void(Step, const std::filesystem::path&)>;

  DurableFiles() = default;
  explicit DurableFiles(Observer observer) : observer_(std::move(observer)) {}

  /// Writes `path` + ".tmp", syncs it, renames it to `path`, syncs the folder. On an error the old
  /// file, if any, is untouched and the temporary one, which no error speaks of, is gone.
  void write(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) const;
  void write(const std::filesystem::path& path, std::string_view text) const;

  /// Makes a folder, its parents too, unless it exists.
  void make_folder(const std::filesystem::path& path) const;

  /// Removes a file if it exists. Not synced: that a file comes back after a power cut does no
  /// harm.
  void remove(const std::filesystem::path& path) const;

 private:
  void write_and_sync(const std::filesystem::path& aside, const std::filesystem::path& path,
                      std::span<const std::uint8_t> bytes) const;
  void sync_folder(const std::filesystem::path& path) const;
  void note(Step step, const std::filesystem::path& path) const {
    if (observer_) observer_(step, path);
  }

  Observer observer_;
};

/// Makes `folder` for something new. Throws config::InputError if it exists and holds anything.
void make_new_folder(const DurableFiles& files, const std::filesystem::path& folder);

}  // namespace lumibox::lightfield
