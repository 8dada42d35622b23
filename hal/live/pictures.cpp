#include "hal/live/pictures.h"

#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>

#include "hal/owned.h"

namespace lumibox::hal::live {
namespace {

using Handle = std::unique_ptr<void, Freed<tjDestroy>>;

/// A picture as JPEG has it: luma and two chroma planes that may be coarser, all of full range.
struct Planes {
  Image luma;
  Image blue, red;             ///< chroma; empty of a grey picture
  int sampling = TJSAMP_GRAY;  ///< how much coarser: one of TJSAMP_*
};

int chroma_width(int sampling, int width) {
  return tjPlaneWidth(1, width, sampling);
}
int chroma_height(int sampling, int height) {
  return tjPlaneHeight(1, height, sampling);
}

Planes make_planes(const Mode& mode, int sampling) {
  Planes planes;
  planes.luma = Image(mode.width, mode.height, 1);
  planes.sampling = sampling;
  if (sampling != TJSAMP_GRAY) {
    planes.blue =
        Image(chroma_width(sampling, mode.width), chroma_height(sampling, mode.height), 1);
    planes.red = planes.blue;
  }
  return planes;
}

/// Maps every value of a plane to what it is in full range.
using Range = std::array<std::uint8_t, 256>;

/// `zero` stays, and `span` steps of the narrow range become 255 (Rec. 601: luma from 16 to 235,
/// chroma from 16 to 240 around 128).
Range make_range(bool limited, int zero_in, int zero_out, int span) {
  Range range{};
  for (int i = 0; i < 256; ++i) {
    const double full = limited ? zero_out + (i - zero_in) * 255.0 / span : i;
    range[static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(std::clamp(std::lround(full), 0L, 255L));
  }
  return range;
}

const Range& luma_range(bool limited) {
  static const Range kLimited = make_range(true, 16, 0, 219);
  static const Range kFull = make_range(false, 0, 0, 255);
  return limited ? kLimited : kFull;
}

const Range& chroma_range(bool limited) {
  static const Range kLimited = make_range(true, 128, 128, 224);
  static const Range kFull = make_range(false, 0, 0, 255);
  return limited ? kLimited : kFull;
}

/// Y0 U Y1 V of every two pixels; chroma half as wide.
Planes split_yuyv(const RawPicture& raw) {
  const Mode& mode = raw.layout.mode;
  Planes planes = make_planes(mode, TJSAMP_422);
  const Range& luma = luma_range(raw.layout.limited_range);
  const Range& chroma = chroma_range(raw.layout.limited_range);
  for (int y = 0; y < mode.height; ++y) {
    const std::uint8_t* source = raw.bytes.data() + static_cast<std::size_t>(y) * raw.layout.stride;
    std::uint8_t* grey = planes.luma.row(y);
    std::uint8_t* blue = planes.blue.row(y);
    std::uint8_t* red = planes.red.row(y);
    for (int pair = 0; pair < mode.width / 2; ++pair, source += 4, grey += 2) {
      grey[0] = luma[source[0]];
      *blue++ = chroma[source[1]];
      grey[1] = luma[source[2]];
      *red++ = chroma[source[3]];
    }
  }
  return planes;
}

void copy_luma(const RawPicture& raw, Image& luma) {
  const Range& range = luma_range(raw.layout.limited_range);
  for (int y = 0; y < luma.height(); ++y) {
    const std::uint8_t* source = raw.bytes.data() + static_cast<std::size_t>(y) * raw.layout.stride;
    std::transform(source, source + luma.width(), luma.row(y),
                   [&range](std::uint8_t value) { return range[value]; });
  }
}

/// A plane of luma, then one of U and V in turn; chroma half as wide and half as high.
Planes split_nv12(const RawPicture& raw) {
  const Mode& mode = raw.layout.mode;
  Planes planes = make_planes(mode, TJSAMP_420);
  copy_luma(raw, planes.luma);
  const Range& chroma = chroma_range(raw.layout.limited_range);
  for (int y = 0; y < planes.blue.height(); ++y) {
    const std::uint8_t* source =
        raw.bytes.data() + static_cast<std::size_t>(mode.height + y) * raw.layout.stride;
    std::uint8_t* blue = planes.blue.row(y);
    std::uint8_t* red = planes.red.row(y);
    for (int x = 0; x < planes.blue.width(); ++x, source += 2) {
      *blue++ = chroma[source[0]];
      *red++ = chroma[source[1]];
    }
  }
  return planes;
}

/// A plane of luma, then one of U and one of V, half as wide and half as high.
Planes split_yuv420(const RawPicture& raw) {
  const Mode& mode = raw.layout.mode;
  Planes planes = make_planes(mode, TJSAMP_420);
  copy_luma(raw, planes.luma);
  const Range& range = chroma_range(raw.layout.limited_range);
  const std::uint8_t* source =
      raw.bytes.data() + static_cast<std::size_t>(mode.height) * raw.layout.stride;
  for (Image* chroma : {&planes.blue, &planes.red}) {
    for (int y = 0; y < chroma->height(); ++y, source += raw.layout.stride / 2) {
      std::transform(source, source + chroma->width(), chroma->row(y),
                     [&range](std::uint8_t value) { return range[value]; });
    }
  }
  return planes;
}

Planes copy_grey(const RawPicture& raw) {
  Planes planes = make_planes(raw.layout.mode, TJSAMP_GRAY);
  copy_luma(raw, planes.luma);
  return planes;
}

/// Where red and blue are in the bytes of a pixel, of which there are so many.
struct RgbOrder {
  int red, blue, bytes;
};

std::optional<RgbOrder> rgb_order_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::Rgb:
      return RgbOrder{0, 2, 3};
    case PixelFormat::Bgr:
      return RgbOrder{2, 0, 3};
    case PixelFormat::Rgbx:
      return RgbOrder{0, 2, 4};
    case PixelFormat::Bgrx:
      return RgbOrder{2, 0, 4};
    default:
      return std::nullopt;
  }
}

Image copy_rgb(const RawPicture& raw, const RgbOrder& order) {
  const Mode& mode = raw.layout.mode;
  Image color(mode.width, mode.height, 3);
  for (int y = 0; y < mode.height; ++y) {
    const std::uint8_t* source = raw.bytes.data() + static_cast<std::size_t>(y) * raw.layout.stride;
    std::uint8_t* target = color.row(y);
    for (int x = 0; x < mode.width; ++x, source += order.bytes, target += 3) {
      target[0] = source[order.red];
      target[1] = source[1];
      target[2] = source[order.blue];
    }
  }
  return color;
}

/// Some webcams fill up their JPEG with bytes that mean nothing before its end (EOI, 0xd9): the
/// picture is whole. Whatever else libjpeg warns of is a picture with grey or smeared patches.
bool is_harmless(void* handle) {
  return tjGetErrorCode(handle) == TJERR_WARNING &&
         std::string_view(tjGetErrorStr2(handle)).find("extraneous bytes before marker 0xd9") !=
             std::string_view::npos;
}

constexpr int kFlags = TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS;

std::optional<Planes> decode_jpeg_planes(const Handle& handle, const RawPicture& raw) {
  int width = 0;
  int height = 0;
  int sampling = 0;
  int colorspace = 0;
  if (tjDecompressHeader3(handle.get(), raw.bytes.data(), raw.bytes.size(), &width, &height,
                          &sampling, &colorspace) != 0) {
    return std::nullopt;
  }
  const Mode& mode = raw.layout.mode;
  const bool right_size =
      width == mode.width && height == mode.height &&
      // Not so where chroma is of every fourth pixel and the width no multiple of it.
      tjPlaneWidth(0, width, sampling) == width && tjPlaneHeight(0, height, sampling) == height;
  if (!right_size || (colorspace != TJCS_YCbCr && colorspace != TJCS_GRAY)) return std::nullopt;

  Planes planes = make_planes(mode, sampling);
  unsigned char* targets[] = {planes.luma.data(), planes.blue.data(), planes.red.data()};
  if (tjDecompressToYUVPlanes(handle.get(), raw.bytes.data(), raw.bytes.size(), targets, width,
                              nullptr, height, kFlags) != 0 &&
      !is_harmless(handle.get())) {
    return std::nullopt;
  }
  return planes;
}

std::optional<Planes> planes_of(const Handle& handle, const RawPicture& raw) {
  switch (raw.layout.mode.format) {
    case PixelFormat::Yuyv:
      return split_yuyv(raw);
    case PixelFormat::Nv12:
      return split_nv12(raw);
    case PixelFormat::Yuv420:
      return split_yuv420(raw);
    case PixelFormat::Grey:
      return copy_grey(raw);
    case PixelFormat::Mjpeg:
      return decode_jpeg_planes(handle, raw);
    default:
      return std::nullopt;
  }
}

/// Colours of planes that are not grey.
std::optional<Image> colour_of(const Handle& handle, const Planes& planes) {
  Image color(planes.luma.width(), planes.luma.height(), 3);
  const unsigned char* sources[] = {planes.luma.data(), planes.blue.data(), planes.red.data()};
  if (tjDecodeYUVPlanes(handle.get(), sources, nullptr, planes.sampling, color.data(),
                        color.width(), static_cast<int>(color.stride()), color.height(), TJPF_RGB,
                        kFlags) != 0) {
    return std::nullopt;
  }
  return color;
}

}  // namespace

std::optional<Frame> decode(const RawPicture& raw) {
  Frame frame;
  frame.index = raw.index;
  frame.timestamp_ns = raw.timestamp_ns;
  if (const auto order = rgb_order_of(raw.layout.mode.format)) {
    frame.color = std::make_shared<const Image>(copy_rgb(raw, *order));
    frame.gray = std::make_shared<const Image>(to_gray(*frame.color));
    return frame;
  }
  const Handle handle(tjInitDecompress());
  std::optional<Planes> planes = planes_of(handle, raw);
  if (!planes) return std::nullopt;
  std::optional<Image> color =
      planes->sampling == TJSAMP_GRAY ? to_rgb(planes->luma) : colour_of(handle, *planes);
  if (!color) return std::nullopt;
  frame.color = std::make_shared<const Image>(*std::move(color));
  frame.gray = std::make_shared<const Image>(std::move(planes->luma));
  return frame;
}

}  // namespace lumibox::hal::live
