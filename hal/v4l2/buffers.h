#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/v4l2/modes.h"
#include "hal/v4l2/video_system.h"

/// The buffers that a camera fills.
namespace lumibox::hal::v4l2 {

/// A buffer that the camera has handed over.
struct Filled {
  std::uint32_t buffer = 0;             ///< which of them
  std::span<const std::uint8_t> bytes;  ///< valid until it is given back
  std::uint32_t sequence = 0;     ///< counts the camera's pictures from the stream's beginning
  std::int64_t timestamp_ns = 0;  ///< CLOCK_MONOTONIC if `monotonic`
  bool monotonic = false;
  bool start_of_exposure = false;  ///< what the time is of; else the end of the frame
  bool faulty = false;             ///< the camera says itself that the picture is damaged
};

enum class Damage {
  None,
  Faulty,   ///< the camera says so
  Short,    ///< fewer bytes than a picture has
  NotJpeg,  ///< does not begin and end as a JPEG does
};

/// In words: "marked as damaged by the camera".
const char* to_string(Damage damage);

/// What can be told without decoding.
Damage damage_of(const Filled& filled, const Layout& layout);

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
  int take(Filled& filled);

  /// 0, or the errno.
  int give_back(const Filled& filled);

 private:
  std::optional<std::string> map_buffers(std::uint32_t count);
  int queue(std::uint32_t buffer);

  VideoDevice& device_;
  std::vector<std::span<std::uint8_t>> buffers_;
};

}  // namespace lumibox::hal::v4l2
