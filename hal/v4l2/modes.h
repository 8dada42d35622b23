#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hal/v4l2/video_system.h"

/// What pictures a camera offers, which of them is wanted, and setting it.
namespace lumibox::hal::v4l2 {

/// Those that can be read here; first what is preferred if all else is equal: without losses before
/// JPEG, with colour before without.
enum class PixelFormat { Yuyv, Nv12, Mjpeg, Grey };

/// As the configuration has it: "mjpeg".
const char* name_of(PixelFormat format);
std::optional<PixelFormat> format_named(std::string_view name);

/// Of one frame, in seconds: a fraction, as drivers want it. 0 / 0 if the camera does not say.
struct Interval {
  std::uint32_t numerator = 0;
  std::uint32_t denominator = 0;

  double rate_hz() const { return numerator == 0 ? 0.0 : double{1} * denominator / numerator; }
};

struct Mode {
  PixelFormat format = PixelFormat::Yuyv;
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  Interval interval;
};

/// "yuyv 640x480 at 30 Hz"
std::string to_string(const Mode& mode);

struct Wish {
  std::optional<PixelFormat> format;  ///< none: whichever serves size and rate best
  int width = 640;
  int height = 480;
  double rate_hz = 30.0;
};

/// Everything the camera offers in a format that can be read here. Where it offers any size or rate
/// in a range, the one nearest to the wish stands for all. Sizes are even, as chroma has it.
/// Bounded, whatever the driver answers: so many entries, and sides of 32768 pixels at most.
std::vector<Mode> list_modes(VideoDevice& device, const Wish& wish);

/// The mode nearest to the wish: first in size, then fast enough, then no faster than that, then by
/// format. None if no mode has the format wished for.
std::optional<Mode> choose(const std::vector<Mode>& modes, const Wish& wish);

/// How the camera lays a picture out in a buffer.
struct Layout {
  Mode mode;                   ///< with the rate that the camera agreed to
  std::size_t stride = 0;      ///< bytes from one row (of luma) to the next; 0 of JPEG
  std::size_t size_bytes = 0;  ///< of a complete picture; 0 of JPEG
  bool limited_range = false;  ///< luma from 16 to 235, chroma from 16 to 240
};

/// Sets a mode, and checks what became of it. The reason if the camera refuses or gives another
/// size or format, or pictures in two halves (interlaced); another rate is taken as it is.
std::variant<Layout, std::string> set_mode(VideoDevice& device, const Mode& mode);

/// "<what>: <why>" of a camera that refused, and what may help.
std::string refusal(const std::string& what, int error);

}  // namespace lumibox::hal::v4l2
