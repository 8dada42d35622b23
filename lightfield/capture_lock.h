#pragma once

#include <filesystem>
#include <memory>

#include "config/error.h"
#include "lightfield/durable_files.h"

namespace lumibox::lightfield {

/// Another process has the right to write.
class CaptureInUse : public config::InputError {
 public:
  explicit CaptureInUse(const std::filesystem::path& folder)
      : InputError(folder, "is being recorded to by another process") {}
};

/// The right to write a capture folder, which one process has at a time: pictures of two recordings
/// would end under each other's poses. It is taken before a capture is read that is to be gone on
/// with, or what was read may be old by then. Reading alone needs none.
///
/// Within a process all who ask for it share it; it goes with the last of them, or with the process
/// however that ends. It is the system's lock of the folder itself: nothing is left on the disk.
class CaptureLock {
 public:
  /// Throws CaptureInUse, or config::InputError if the folder cannot be opened. Where the file
  /// system has no locks it is given to everybody.
  explicit CaptureLock(const std::filesystem::path& folder);

 private:
  std::shared_ptr<const void> share_;
};

/// Makes `folder` for a new capture and takes its lock. Throws config::InputError if it exists and
/// holds anything, CaptureInUse if another process is about to record into it.
CaptureLock make_capture_folder(const DurableFiles& files, const std::filesystem::path& folder);

}  // namespace lumibox::lightfield
