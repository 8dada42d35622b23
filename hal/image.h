#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lumibox::hal {

/// An 8-bit picture: rows from the top, channels interleaved, no padding. One channel is grey,
/// three are red, green, blue with the sRGB transfer curve.
class Image {
 public:
  Image() = default;
  Image(int width, int height, int channels)
      : width_(width),
        height_(height),
        channels_(channels),
        bytes_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
               static_cast<std::size_t>(channels)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }
  bool empty() const { return bytes_.empty(); }

  std::uint8_t* data() { return bytes_.data(); }
  const std::uint8_t* data() const { return bytes_.data(); }
  std::size_t size_bytes() const { return bytes_.size(); }
  std::size_t stride() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(channels_);
  }

  std::uint8_t* row(int y) { return data() + static_cast<std::size_t>(y) * stride(); }
  const std::uint8_t* row(int y) const { return data() + static_cast<std::size_t>(y) * stride(); }

  /// Pixel (x, y): pointer to its first channel.
  std::uint8_t* at(int x, int y) {
    return row(y) + static_cast<std::size_t>(x) * static_cast<std::size_t>(channels_);
  }
  const std::uint8_t* at(int x, int y) const {
    return row(y) + static_cast<std::size_t>(x) * static_cast<std::size_t>(channels_);
  }

  bool operator==(const Image&) const = default;

 private:
  int width_ = 0;
  int height_ = 0;
  int channels_ = 0;
  std::vector<std::uint8_t> bytes_;
};

/// Grey picture of a colour one (Rec. 601 luma, as JPEG has it); a grey one is copied.
Image to_gray(const Image& image);

/// Three-channel picture of a grey one; a colour one is copied.
Image to_rgb(const Image& image);

}  // namespace lumibox::hal
