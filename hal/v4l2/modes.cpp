#include "hal/v4l2/modes.h"

#include <fmt/core.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <tuple>
#include <utility>

#include "config/error_text.h"

namespace lumibox::hal::v4l2 {
namespace {

struct Format {
  PixelFormat format;
  const char* name;
  std::uint32_t fourcc;
};

constexpr std::array<Format, 4> kFormats{{{PixelFormat::Yuyv, "yuyv", V4L2_PIX_FMT_YUYV},
                                          {PixelFormat::Nv12, "nv12", V4L2_PIX_FMT_NV12},
                                          {PixelFormat::Mjpeg, "mjpeg", V4L2_PIX_FMT_MJPEG},
                                          {PixelFormat::Grey, "grey", V4L2_PIX_FMT_GREY}}};

const Format& row_of(PixelFormat format) {
  return kFormats[static_cast<std::size_t>(format)];
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

// Pixels a side: more than any camera has, and few enough for any product of two.
constexpr std::uint32_t kLargestSide = 32768;

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

int nearest_on_grid(int wish, std::uint32_t least, std::uint32_t most, std::uint32_t step) {
  const std::int64_t low = std::min(least, kLargestSide);
  const std::int64_t high = std::max(low, std::int64_t{std::min(most, kLargestSide)});
  const std::int64_t pitch = std::clamp(step, 1U, kLargestSide);
  const std::int64_t steps = (std::clamp(std::int64_t{wish}, low, high) - low + pitch / 2) / pitch;
  const std::int64_t nearest = low + steps * pitch;
  return static_cast<int>(nearest <= high ? nearest : nearest - pitch);
}

std::vector<Size> list_sizes(VideoDevice& device, std::uint32_t fourcc, const Wish& wish) {
  v4l2_frmsizeenum question{};
  question.pixel_format = fourcc;
  std::vector<Size> sizes;
  for (const auto& answer : enumerate(device, VIDIOC_ENUM_FRAMESIZES, question)) {
    if (answer.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      const auto [width, height] = answer.discrete;
      if (std::max(width, height) > kLargestSide) continue;
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

/// Smaller is better; the order of the numbers is the order of what matters.
auto badness(const Mode& mode, const Wish& wish) {
  const double size = std::abs(std::log(double{1} * mode.width / wish.width)) +
                      std::abs(std::log(double{1} * mode.height / wish.height));
  // Rates are rounded in many ways: 29.97 is 30.
  constexpr double kSameRate = 0.01;
  const double rate = mode.interval.rate_hz();
  const double too_slow = rate < wish.rate_hz * (1.0 - kSameRate) ? wish.rate_hz - rate : 0.0;
  const double too_fast = rate > wish.rate_hz * (1.0 + kSameRate) ? rate - wish.rate_hz : 0.0;
  return std::tuple(size, too_slow, too_fast, static_cast<int>(mode.format));
}

std::size_t least_stride(const Mode& mode) {
  const auto width = static_cast<std::size_t>(mode.width);
  return mode.format == PixelFormat::Yuyv ? 2 * width : width;
}

Layout layout_of(const Mode& mode, const v4l2_pix_format& pix) {
  Layout layout;
  layout.mode = mode;
  if (mode.format == PixelFormat::Mjpeg) return layout;
  layout.stride = std::max(std::size_t{pix.bytesperline}, least_stride(mode));
  layout.size_bytes = layout.stride * static_cast<std::size_t>(mode.height);
  if (mode.format == PixelFormat::Nv12) layout.size_bytes += layout.size_bytes / 2;
  const auto usual = V4L2_MAP_QUANTIZATION_DEFAULT(false, pix.colorspace, V4L2_YCBCR_ENC_DEFAULT);
  const std::uint32_t range = pix.quantization == V4L2_QUANTIZATION_DEFAULT
                                  ? static_cast<std::uint32_t>(usual)
                                  : pix.quantization;
  layout.limited_range = mode.format != PixelFormat::Grey && range == V4L2_QUANTIZATION_LIM_RANGE;
  return layout;
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

const char* name_of(PixelFormat format) {
  return row_of(format).name;
}

std::optional<PixelFormat> format_named(std::string_view name) {
  const auto* found = std::ranges::find(kFormats, name, &Format::name);
  return found == kFormats.end() ? std::nullopt : std::optional(found->format);
}

std::string to_string(const Mode& mode) {
  const double rate = mode.interval.rate_hz();
  return fmt::format("{} {}x{}", name_of(mode.format), mode.width, mode.height) +
         (rate > 0.0 ? fmt::format(" at {:.4g} Hz", rate) : " at a rate that it does not say");
}

std::vector<Mode> list_modes(VideoDevice& device, const Wish& wish) {
  v4l2_fmtdesc question{};
  question.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  std::vector<Mode> modes;
  for (const auto& answer : enumerate(device, VIDIOC_ENUM_FMT, question)) {
    const std::optional<PixelFormat> format = format_of(answer.pixelformat);
    if (!format) continue;
    for (const Size size : list_sizes(device, answer.pixelformat, wish)) {
      if (size.width < 2 || size.height < 2 || size.width % 2 != 0 || size.height % 2 != 0)
        continue;
      for (const Interval interval :
           list_intervals(device, answer.pixelformat, size, wish.rate_hz)) {
        modes.push_back({*format, size.width, size.height, interval});
      }
      if (modes.size() >= kMostModes) return modes;
    }
  }
  return modes;
}

std::optional<Mode> choose(const std::vector<Mode>& modes, const Wish& wish) {
  std::optional<Mode> best;
  for (const Mode& mode : modes) {
    if (wish.format && mode.format != *wish.format) continue;
    if (!best || badness(mode, wish) < badness(*best, wish)) best = mode;
  }
  return best;
}

std::variant<Layout, std::string> set_mode(VideoDevice& device, const Mode& mode) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_pix_format& pix = format.fmt.pix;
  pix.width = static_cast<std::uint32_t>(mode.width);
  pix.height = static_cast<std::uint32_t>(mode.height);
  pix.pixelformat = row_of(mode.format).fourcc;
  pix.field = V4L2_FIELD_NONE;
  if (const int error = device.ioctl(VIDIOC_S_FMT, &format); error != 0) {
    return refusal("refuses " + to_string(mode), error);
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
  Layout layout = layout_of(mode, pix);
  layout.mode.interval = set_interval(device, mode.interval);
  return layout;
}

std::string refusal(const std::string& what, int error) {
  const char* hint = error == EBUSY ? "; is another program using it?" : "";
  return what + ": " + config::error_text(error) + hint;
}

}  // namespace lumibox::hal::v4l2
