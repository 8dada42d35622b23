#include "hal/live/filled.h"

namespace lumibox::hal::live {
namespace {

// The smallest JPEG that can be made, of one grey pixel, has 125 bytes.
constexpr std::size_t kSmallestJpeg = 125;

/// Begins with SOI and ends with EOI; cameras pad with zeros after that.
bool is_whole_jpeg(std::span<const std::uint8_t> bytes) {
  std::size_t size = bytes.size();
  while (size > 0 && bytes[size - 1] == 0) --size;
  return size >= 4 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[size - 2] == 0xFF &&
         bytes[size - 1] == 0xD9;
}

}  // namespace

std::vector<std::uint8_t> copy_of(const Filled& filled) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(filled.size_bytes());
  for (const std::span<const std::uint8_t> plane : filled.bytes) {
    bytes.insert(bytes.end(), plane.begin(), plane.end());
  }
  return bytes;
}

const char* to_string(Damage damage) {
  switch (damage) {
    case Damage::None:
      break;
    case Damage::Faulty:
      return "marked as damaged by the camera";
    case Damage::Short:
      return "too few bytes";
    case Damage::NotJpeg:
      return "not a complete JPEG";
  }
  return "whole";
}

Damage damage_of(const Filled& filled, const Layout& layout) {
  if (filled.faulty) return Damage::Faulty;
  if (layout.mode.format != PixelFormat::Mjpeg) {
    return filled.size_bytes() < layout.size_bytes ? Damage::Short : Damage::None;
  }
  if (filled.size_bytes() < kSmallestJpeg) return Damage::Short;
  return is_whole_jpeg(filled.bytes[0]) ? Damage::None : Damage::NotJpeg;
}

}  // namespace lumibox::hal::live
