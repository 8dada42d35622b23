#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// What real cameras have in common, whatever they are driven by: here what pictures one offers and
/// which of them is wanted.
namespace lumibox::hal::live {

/// Those that can be read here; first what is preferred if all else is equal: without losses before
/// JPEG, with colour before without. Bytes of RGB are named in the order of memory, X is unused.
enum class PixelFormat { Yuyv, Nv12, Yuv420, Rgb, Bgr, Rgbx, Bgrx, Mjpeg, Grey };

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
  bool exact_size = false;  ///< this size or none
};

/// Pixels: more than any camera has, and few enough for any product of two.
constexpr std::uint32_t kLargestSide = 32768;

/// A width or height that a camera offers in steps: the one nearest to the wish, and none over
/// kLargestSide, whatever the camera says.
int nearest_on_grid(int wish, std::uint32_t least, std::uint32_t most, std::uint32_t step);

/// Whether pictures of this size can be read: it is even, as chroma has it, and within reason.
bool is_readable_size(int width, int height);

/// The mode nearest to the wish: first in size, then fast enough, then no faster than that, then by
/// format. None if no mode has the format wished for.
std::optional<Mode> choose(const std::vector<Mode>& modes, const Wish& wish);

/// The same; or, in words, why there is none that will do.
std::variant<Mode, std::string> decide(const std::vector<Mode>& modes, const Wish& wish);

/// What asks for just this mode of a camera that was chosen by `wish`.
Wish again(const Wish& wish, const Mode& mode);

/// "mjpeg, yuyv in 9 sizes up to 1920x1080", of at least one mode.
std::string offer_of(const std::vector<Mode>& modes);

/// How the camera lays a picture out in a buffer: row by row, plane by plane.
struct Layout {
  Mode mode;                   ///< with the rate that the camera agreed to
  std::size_t stride = 0;      ///< bytes from one row (of luma) to the next; 0 of JPEG
  std::size_t size_bytes = 0;  ///< of a complete picture; 0 of JPEG
  bool limited_range = false;  ///< luma from 16 to 235, chroma from 16 to 240
};

/// Of a mode whose rows are `stride` bytes apart, or as near as they can be if that is less.
Layout make_layout(const Mode& mode, std::size_t stride, bool limited_range);

/// Bytes of each plane of a picture of this layout; none of JPEG.
std::vector<std::size_t> plane_sizes(const Layout& layout);

}  // namespace lumibox::hal::live
