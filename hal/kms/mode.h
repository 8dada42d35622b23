#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lumibox::hal::kms {

struct Size {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  bool operator==(const Size&) const = default;
};

/// Bytes of the kernel's struct drm_mode_modeinfo.
inline constexpr std::size_t kTimingBytes = 68;

/// One way to drive a screen.
struct Mode {
  Size size;
  double refresh_hz = 0.0;  ///< pictures per second
  bool preferred = false;   ///< the screen's own choice
  bool interlaced = false;
  std::array<std::byte, kTimingBytes> timing{};  ///< all of it, as the kernel has it
};

/// A mode that somebody wishes for; without a refresh rate any will do.
struct ModeWish {
  Size size;
  std::optional<double> refresh_hz;
};

/// "1280x720" or "1280x720@60"; none if the text is anything else.
std::optional<ModeWish> parse_mode_wish(std::string_view text);

/// Without a wish the mode that the screen prefers, else its largest. With one the mode of that
/// size whose refresh rate is nearest, within half a Hz; without a rate the preferred or fastest.
/// None if the screen has no such mode.
std::optional<Mode> choose_mode(std::span<const Mode> modes, const std::optional<ModeWish>& wish);

std::string name_of(const Mode& mode);                     ///< "1280x720@60"
std::string names_of(std::span<const Mode> modes);         ///< each once, with commas
std::string name_of(const std::optional<ModeWish>& wish);  ///< as it is parsed

}  // namespace lumibox::hal::kms
