#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hal/frame.h"
#include "hal/live/modes.h"

namespace lumibox::hal::live {

/// A picture as the camera gave it, in memory of our own.
struct RawPicture {
  Layout layout;
  std::vector<std::uint8_t> bytes;
  std::int64_t index = 0;         ///< as Frame has it
  std::int64_t timestamp_ns = 0;  ///< as Frame has it
};

/// Grey is the camera's own luma, where it gives any, without a detour over colours, and colour is
/// made of the same planes (Rec. 601, as JPEG has it). None if it is a JPEG that is damaged or of
/// another size.
std::optional<Frame> decode(const RawPicture& raw);

}  // namespace lumibox::hal::live
