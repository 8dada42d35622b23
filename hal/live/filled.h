#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/live/modes.h"

/// A picture while it is in the camera's memory, and what is wrong with it.
namespace lumibox::hal::live {

/// A buffer that the camera has handed over; what is in it is valid until it is given back.
struct Filled {
  std::uint32_t buffer = 0;  ///< which of them
  /// As Layout has it, in one piece or in one for each plane.
  std::array<std::span<const std::uint8_t>, 3> bytes;
  std::uint32_t sequence = 0;     ///< counts the camera's pictures from the stream's beginning
  std::int64_t timestamp_ns = 0;  ///< CLOCK_MONOTONIC if `monotonic`
  bool monotonic = false;
  bool start_of_exposure = false;  ///< what the time is of; else the end of the frame
  bool faulty = false;             ///< the camera says itself that the picture is damaged

  std::size_t size_bytes() const { return bytes[0].size() + bytes[1].size() + bytes[2].size(); }
};

/// The bytes of all planes, one after the other, in memory of our own.
std::vector<std::uint8_t> copy_of(const Filled& filled);

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

}  // namespace lumibox::hal::live
