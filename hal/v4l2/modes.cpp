#include "hal/v4l2/modes.h"

#include <fmt/core.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "hal/live/refusal.h"

namespace lumibox::hal::v4l2 {
namespace {

using live::Interval;
using live::Layout;
using live::Mode;
using live::nearest_on_grid;
using live::PixelFormat;
using live::Wish;

struct Format {
  PixelFormat format;
  std::uint32_t fourcc;
};

constexpr std::array<Format, 9> kFormats{{{PixelFormat::Yuyv, V4L2_PIX_FMT_YUYV},
                                          {PixelFormat::Nv12, V4L2_PIX_FMT_NV12},
                                          {PixelFormat::Yuv420, V4L2_PIX_FMT_YUV420},
                                          {PixelFormat::Rgb, V4L2_PIX_FMT_RGB24},
                                          {PixelFormat::Bgr, V4L2_PIX_FMT_BGR24},
                                          {PixelFormat::Rgbx, V4L2_PIX_FMT_RGBX32},
                                          {PixelFormat::Bgrx, V4L2_PIX_FMT_XBGR32},
                                          {PixelFormat::Mjpeg, V4L2_PIX_FMT_MJPEG},
                                          {PixelFormat::Grey, V4L2_PIX_FMT_GREY}}};

std::uint32_t fourcc_of(PixelFormat format) {
  return std::ranges::find(kFormats, format, &Format::format)->fourcc;
}

/// Some drivers call theirs JPEG, which is the same.
std::optional<PixelFormat> format_of(std::uint32_t fourcc) {
  if (fourcc == V4L2_PIX_FMT_JPEG) return PixelFormat::Mjpeg;
  const auto* found = std::ranges::find(kFormats, fourcc, &Format::fourcc);
  return found == kFormats.end() ? std::nullopt : std::optional(found->format);
}

struct Size {
  int width = 0;
  int height = 0;
};

// No camera offers as many; a driver that never says that there are no more must not hold us up.
constexpr std::uint32_t kMostEntries = 512;
constexpr std::size_t kMostModes = 4096;  // entries of entries of entries

/// All answers to a question that the driver answers one by one, up to its first refusal.
template <typename Item>
std::vector<Item> enumerate(VideoDevice& device, unsigned long request, Item item) {
  std::vector<Item> items;
  for (item.index = 0; item.index < kMostEntries; ++item.index) {
    Item answer = item;
    if (device.ioctl(request, &answer) != 0) break;
    items.push_back(answer);
  }
  return items;
}

std::vector<Size> list_sizes(VideoDevice& device, std::uint32_t fourcc, const Wish& wish) {
  v4l2_frmsizeenum question{};
  question.pixel_format = fourcc;
  std::vector<Size> sizes;
  for (const auto& answer : enumerate(device, VIDIOC_ENUM_FRAMESIZES, question)) {
    if (answer.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      const auto [width, height] = answer.discrete;
      if (std::max(width, height) > live::kLargestSide) continue;
      sizes.push_back({static_cast<int>(width), static_cast<int>(height)});
      continue;
    }
    const v4l2_frmsize_stepwise& range = answer.stepwise;
    sizes.push_back(
        {nearest_on_grid(wish.width, range.min_width, range.max_width, range.step_width),
         nearest_on_grid(wish.height, range.min_height, range.max_height, range.step_height)});
    break;
  }
  if (sizes.empty()) sizes.push_back({wish.width, wish.height});  // set_mode() finds out
  return sizes;
}

/// What lies nearest to the wish within a range of intervals.
Interval nearest_interval(const v4l2_frmival_stepwise& range, double wished_hz) {
  const Interval shortest{range.min.numerator, range.min.denominator};
  const Interval longest{range.max.numerator, range.max.denominator};
  if (wished_hz >= shortest.rate_hz()) return shortest;
  if (wished_hz <= longest.rate_hz()) return longest;
  constexpr std::uint32_t kParts = 1000;
  return {kParts, static_cast<std::uint32_t>(std::lround(kParts * wished_hz))};
}

std::vector<Interval> list_intervals(VideoDevice& device, std::uint32_t fourcc, Size size,
                                     double wished_hz) {
  v4l2_frmivalenum question{};
  question.pixel_format = fourcc;
  question.width = static_cast<std::uint32_t>(size.width);
  question.height = static_cast<std::uint32_t>(size.height);
  std::vector<Interval> intervals;
  for (const auto& answer : enumerate(device, VIDIOC_ENUM_FRAMEINTERVALS, question)) {
    if (answer.type != V4L2_FRMIVAL_TYPE_DISCRETE) {
      intervals.push_back(nearest_interval(answer.stepwise, wished_hz));
      break;
    }
    intervals.push_back({answer.discrete.numerator, answer.discrete.denominator});
  }
  if (intervals.empty()) intervals.emplace_back();
  return intervals;
}

bool has_limited_range(const v4l2_pix_format& pix) {
  const auto usual = V4L2_MAP_QUANTIZATION_DEFAULT(false, pix.colorspace, V4L2_YCBCR_ENC_DEFAULT);
  const std::uint32_t range = pix.quantization == V4L2_QUANTIZATION_DEFAULT
                                  ? static_cast<std::uint32_t>(usual)
                                  : pix.quantization;
  return range == V4L2_QUANTIZATION_LIM_RANGE;
}

/// The interval that the camera keeps to, after it was asked for one. Cameras that cannot be asked
/// say what it is, or not even that.
Interval set_interval(VideoDevice& device, Interval wished) {
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (device.ioctl(VIDIOC_G_PARM, &parameters) != 0) return wished;
  v4l2_captureparm& capture = parameters.parm.capture;
  if ((capture.capability & V4L2_CAP_TIMEPERFRAME) != 0 && wished.numerator != 0) {
    capture.timeperframe = {wished.numerator, wished.denominator};
    device.ioctl(VIDIOC_S_PARM, &parameters);  // what became of it is asked next
    if (device.ioctl(VIDIOC_G_PARM, &parameters) != 0) return wished;
  }
  const Interval kept{capture.timeperframe.numerator, capture.timeperframe.denominator};
  return kept.rate_hz() > 0.0 ? kept : wished;
}

}  // namespace

std::vector<Mode> list_modes(VideoDevice& device, const Wish& wish) {
  v4l2_fmtdesc question{};
  question.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  std::vector<Mode> modes;
  for (const auto& answer : enumerate(device, VIDIOC_ENUM_FMT, question)) {
    const std::optional<PixelFormat> format = format_of(answer.pixelformat);
    if (!format) continue;
    for (const Size size : list_sizes(device, answer.pixelformat, wish)) {
      if (!live::is_readable_size(size.width, size.height)) continue;
      for (const Interval interval :
           list_intervals(device, answer.pixelformat, size, wish.rate_hz)) {
        modes.push_back({*format, size.width, size.height, interval});
      }
      if (modes.size() >= kMostModes) return modes;
    }
  }
  return modes;
}

std::variant<Layout, std::string> set_mode(VideoDevice& device, const Mode& mode) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_pix_format& pix = format.fmt.pix;
  pix.width = static_cast<std::uint32_t>(mode.width);
  pix.height = static_cast<std::uint32_t>(mode.height);
  pix.pixelformat = fourcc_of(mode.format);
  pix.field = V4L2_FIELD_NONE;
  if (const int error = device.ioctl(VIDIOC_S_FMT, &format); error != 0) {
    return live::refusal("refuses " + to_string(mode), error);
  }
  if (format_of(pix.pixelformat) != mode.format ||
      pix.width != static_cast<std::uint32_t>(mode.width) ||
      pix.height != static_cast<std::uint32_t>(mode.height)) {
    return fmt::format("was asked for {} and gives {}x{} in {}", to_string(mode), pix.width,
                       pix.height,
                       format_of(pix.pixelformat) ? name_of(*format_of(pix.pixelformat))
                                                  : "a format that is not read here");
  }
  if (pix.field != V4L2_FIELD_NONE && pix.field != V4L2_FIELD_ANY) {  // the latter: it does not say
    return fmt::format("gives {} interlaced; expected whole pictures (progressive)",
                       to_string(mode));
  }
  Layout layout = live::make_layout(mode, pix.bytesperline, has_limited_range(pix));
  layout.mode.interval = set_interval(device, mode.interval);
  return layout;
}

}  // namespace lumibox::hal::v4l2
