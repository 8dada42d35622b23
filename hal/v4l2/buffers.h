#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/live/filled.h"
#include "hal/v4l2/video_system.h"

/// The buffers that a camera fills.
namespace lumibox::hal::v4l2 {

/// A stream: begun by begin(), ended with the object. The device must outlive it.
class BufferRing {
 public:
  explicit BufferRing(VideoDevice& device) : device_(device) {}
  ~BufferRing();
  BufferRing(const BufferRing&) = delete;
  BufferRing& operator=(const BufferRing&) = delete;

  /// Gives the camera its buffers and lets it begin. The reason if it refuses.
  std::optional<std::string> begin();

  /// The next filled buffer; EAGAIN if there is none, another errno if the stream is broken.
  int take(live::Filled& filled);

  /// 0, or the errno.
  int give_back(const live::Filled& filled);

 private:
  std::optional<std::string> map_buffers(std::uint32_t count);
  int queue(std::uint32_t buffer);

  VideoDevice& device_;
  std::vector<std::span<std::uint8_t>> buffers_;
};

}  // namespace lumibox::hal::v4l2
