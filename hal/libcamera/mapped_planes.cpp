#include "hal/libcamera/mapped_planes.h"

#include <linux/dma-buf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <utility>

namespace lumibox::hal::libcam {

std::variant<MappedPlanes, int> MappedPlanes::map(const std::vector<Plane>& planes) {
  std::map<int, std::size_t> length_of;
  for (const Plane& plane : planes) {
    std::size_t& length = length_of[plane.file];
    length = std::max(length, plane.offset + plane.length);
  }
  MappedPlanes mapped;
  std::map<int, std::span<std::uint8_t>> memory_of;
  for (const auto& [file, length] : length_of) {
    void* memory = mmap(nullptr, length, PROT_READ, MAP_SHARED, file, 0);
    if (memory == MAP_FAILED) return errno;
    memory_of[file] = {static_cast<std::uint8_t*>(memory), length};
    mapped.areas_.push_back({file, memory_of[file]});
  }
  for (const Plane& plane : planes) {
    mapped.planes_.emplace_back(memory_of[plane.file].subspan(plane.offset, plane.length));
  }
  return mapped;
}

MappedPlanes::~MappedPlanes() {
  for (const Area& area : areas_) munmap(area.memory.data(), area.memory.size());
}

MappedPlanes::MappedPlanes(MappedPlanes&& other) noexcept
    : areas_(std::exchange(other.areas_, {})), planes_(std::exchange(other.planes_, {})) {}

void MappedPlanes::begin_read() const {
  sync(DMA_BUF_SYNC_START | DMA_BUF_SYNC_READ);
}

void MappedPlanes::end_read() const {
  sync(DMA_BUF_SYNC_END | DMA_BUF_SYNC_READ);
}

void MappedPlanes::sync(std::uint64_t flags) const {
  for (const Area& area : areas_) {
    dma_buf_sync request{};
    request.flags = flags;
    // Another error than these is that of a file without caches to look after.
    while (ioctl(area.file, DMA_BUF_IOCTL_SYNC, &request) < 0 &&
           (errno == EINTR || errno == EAGAIN)) {
    }
  }
}

}  // namespace lumibox::hal::libcam
