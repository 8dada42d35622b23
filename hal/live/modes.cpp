#include "hal/live/modes.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace lumibox::hal::live {
namespace {

// In the order of the enumeration.
constexpr std::array<const char*, 9> kNames{"yuyv", "nv12", "yuv420", "rgb", "bgr",
                                            "rgbx", "bgrx", "mjpeg",  "grey"};

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

std::set<std::pair<int, int>> sizes_in(const std::vector<Mode>& modes) {
  std::set<std::pair<int, int>> sizes;
  for (const Mode& mode : modes) sizes.emplace(mode.width, mode.height);
  return sizes;
}

std::string sizes_of(const std::vector<Mode>& modes) {
  std::string text;
  for (const auto& [width, height] : sizes_in(modes)) {
    text += fmt::format("{}{}x{}", text.empty() ? "" : ", ", width, height);
  }
  return text;
}

std::string formats_of(const std::vector<Mode>& modes) {
  std::set<PixelFormat> formats;
  for (const Mode& mode : modes) formats.insert(mode.format);
  std::string text;
  for (const PixelFormat format : formats)
    text += (text.empty() ? "" : ", ") + std::string(name_of(format));
  return text;
}

std::size_t bytes_per_pixel_of_first_plane(PixelFormat format) {
  switch (format) {
    case PixelFormat::Yuyv:
      return 2;
    case PixelFormat::Rgb:
    case PixelFormat::Bgr:
      return 3;
    case PixelFormat::Rgbx:
    case PixelFormat::Bgrx:
      return 4;
    case PixelFormat::Nv12:
    case PixelFormat::Yuv420:
    case PixelFormat::Grey:
    case PixelFormat::Mjpeg:
      break;
  }
  return 1;
}

}  // namespace

const char* name_of(PixelFormat format) {
  return kNames[static_cast<std::size_t>(format)];
}

std::optional<PixelFormat> format_named(std::string_view name) {
  const auto* found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<PixelFormat>(found - kNames.begin());
}

std::string to_string(const Mode& mode) {
  const double rate = mode.interval.rate_hz();
  return fmt::format("{} {}x{}", name_of(mode.format), mode.width, mode.height) +
         (rate > 0.0 ? fmt::format(" at {:.4g} Hz", rate) : " at a rate that it does not say");
}

int nearest_on_grid(int wish, std::uint32_t least, std::uint32_t most, std::uint32_t step) {
  const std::int64_t low = std::min(least, kLargestSide);
  const std::int64_t high = std::max(low, std::int64_t{std::min(most, kLargestSide)});
  const std::int64_t pitch = std::clamp(step, 1U, kLargestSide);
  const std::int64_t steps = (std::clamp(std::int64_t{wish}, low, high) - low + pitch / 2) / pitch;
  const std::int64_t nearest = low + steps * pitch;
  return static_cast<int>(nearest <= high ? nearest : nearest - pitch);
}

bool is_readable_size(int width, int height) {
  const auto is_readable = [](int side) {
    return side >= 2 && side % 2 == 0 && side <= static_cast<int>(kLargestSide);
  };
  return is_readable(width) && is_readable(height);
}

std::optional<Mode> choose(const std::vector<Mode>& modes, const Wish& wish) {
  std::optional<Mode> best;
  for (const Mode& mode : modes) {
    if (wish.format && mode.format != *wish.format) continue;
    if (!best || badness(mode, wish) < badness(*best, wish)) best = mode;
  }
  return best;
}

std::variant<Mode, std::string> decide(const std::vector<Mode>& modes, const Wish& wish) {
  if (modes.empty()) return std::string("no format that can be read here");
  const std::optional<Mode> mode = choose(modes, wish);
  if (!mode) {
    return fmt::format("no {}; it has {}", name_of(*wish.format), formats_of(modes));
  }
  if (wish.exact_size && (mode->width != wish.width || mode->height != wish.height)) {
    return fmt::format(
        "no pictures of {}x{}{}, which the calibration is of; it has {}", wish.width, wish.height,
        wish.format ? std::string(" in ") + name_of(*wish.format) : std::string(), sizes_of(modes));
  }
  return *mode;
}

Wish again(const Wish& wish, const Mode& mode) {
  const double rate = mode.interval.rate_hz();
  return {mode.format, mode.width, mode.height, rate > 0.0 ? rate : wish.rate_hz, true};
}

std::string offer_of(const std::vector<Mode>& modes) {
  const std::set<std::pair<int, int>> sizes = sizes_in(modes);
  const auto largest = std::ranges::max(sizes, {}, [](const std::pair<int, int>& size) {
    return std::int64_t{size.first} * size.second;
  });
  return fmt::format("{} in {} size{} up to {}x{}", formats_of(modes), sizes.size(),
                     sizes.size() == 1 ? "" : "s", largest.first, largest.second);
}

Layout make_layout(const Mode& mode, std::size_t stride, bool limited_range) {
  Layout layout;
  layout.mode = mode;
  if (mode.format == PixelFormat::Mjpeg) return layout;
  layout.stride = std::max(
      stride, static_cast<std::size_t>(mode.width) * bytes_per_pixel_of_first_plane(mode.format));
  const std::vector<std::size_t> planes = plane_sizes(layout);
  layout.size_bytes = std::accumulate(planes.begin(), planes.end(), std::size_t{0});
  const bool is_yuv = mode.format == PixelFormat::Yuyv || mode.format == PixelFormat::Nv12 ||
                      mode.format == PixelFormat::Yuv420;
  layout.limited_range = limited_range && is_yuv;
  return layout;
}

std::vector<std::size_t> plane_sizes(const Layout& layout) {
  const std::size_t first = layout.stride * static_cast<std::size_t>(layout.mode.height);
  switch (layout.mode.format) {
    case PixelFormat::Mjpeg:
      return {};
    case PixelFormat::Nv12:
      return {first, first / 2};
    case PixelFormat::Yuv420:
      return {first, first / 4, first / 4};
    default:
      return {first};
  }
}

}  // namespace lumibox::hal::live
