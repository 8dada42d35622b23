#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace lumibox::hal::libcam {

/// The planes of a picture in memory that devices share as files (dma-buf), several of them
/// possibly in one file.
class MappedPlanes {
 public:
  struct Plane {
    int file = -1;           ///< its descriptor; stays the caller's
    std::size_t offset = 0;  ///< bytes
    std::size_t length = 0;  ///< bytes
  };

  /// The mapped planes or the errno. The files must stay open as long as the object lives.
  static std::variant<MappedPlanes, int> map(const std::vector<Plane>& planes);

  ~MappedPlanes();
  MappedPlanes(MappedPlanes&& other) noexcept;
  MappedPlanes& operator=(MappedPlanes&&) = delete;

  /// In the order of the planes. What is in them may be read between begin_read() and end_read().
  const std::vector<std::span<const std::uint8_t>>& planes() const { return planes_; }

  /// What the device has written is seen by the processor from here on (DMA_BUF_IOCTL_SYNC), and
  /// until there. Memory that is no dma-buf needs neither.
  void begin_read() const;
  void end_read() const;

 private:
  struct Area {
    int file;
    std::span<std::uint8_t> memory;
  };

  MappedPlanes() = default;
  void sync(std::uint64_t flags) const;

  std::vector<Area> areas_;  ///< one of each file
  std::vector<std::span<const std::uint8_t>> planes_;
};

}  // namespace lumibox::hal::libcam
