#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// The system calls that cameras are driven with, and nothing more: tests put cameras in memory in
/// their place.
namespace lumibox::hal::v4l2 {

/// One open video device; closed with the object.
class VideoDevice {
 public:
  virtual ~VideoDevice() = default;

  /// 0, or the errno. Begun anew if a signal interrupts it; EAGAIN where it would block.
  virtual int ioctl(unsigned long request, void* argument) = 0;

  /// Memory that the device shares; empty if it refuses.
  virtual std::span<std::uint8_t> map(std::size_t length, std::int64_t offset) = 0;
  virtual void unmap(std::span<std::uint8_t> memory) = 0;

  /// Whether poll() reports an error or a hang-up.
  virtual bool hung_up() = 0;

  /// Readable when a buffer is filled.
  virtual int poll_fd() const = 0;
};

/// A device or the errno.
struct Opened {
  std::unique_ptr<VideoDevice> device;
  int error = 0;
};

/// A node of the file system that a video device stands behind.
struct Node {
  std::string path;  ///< /dev/video0
  std::string
      stable_path;  ///< /dev/v4l/by-id/..., the same after every start; empty if there is none
};

class VideoSystem {
 public:
  virtual ~VideoSystem() = default;

  /// All there are, by number.
  virtual std::vector<Node> nodes() = 0;

  virtual Opened open(const std::string& path) = 0;

  /// Whether a video device has come or gone since this was last asked. Never true where nobody
  /// tells.
  virtual bool changed() = 0;

  /// Readable when changed() will be true; -1 where nobody tells.
  virtual int watch_fd() const = 0;
};

/// The cameras of this machine.
std::unique_ptr<VideoSystem> linux_video_system();

}  // namespace lumibox::hal::v4l2
