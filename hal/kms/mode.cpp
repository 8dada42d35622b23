#include "hal/kms/mode.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>
#include <vector>

namespace lumibox::hal::kms {
namespace {

constexpr int kLargest = 16384;      // pixels a side; no card has more
constexpr double kLargestHz = 1000;  // likewise
constexpr double kRateMargin = 0.5;  // Hz: 59.94 is what people call 60

/// Reads a number at the beginning of `text` and takes it away from there.
template <typename Number>
std::optional<Number> take_number(std::string_view& text, Number largest) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !(number > 0 && number <= largest)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

bool take_letter(std::string_view& text, char letter) {
  const bool there = text.starts_with(letter);
  if (there) text.remove_prefix(1);
  return there;
}

std::string name_of(const Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

std::string rate_of(double hz) {
  return '@' + std::to_string(std::lround(hz));
}

}  // namespace

std::optional<ModeWish> parse_mode_wish(std::string_view text) {
  const auto width = take_number(text, kLargest);
  if (!width || !take_letter(text, 'x')) return std::nullopt;
  const auto height = take_number(text, kLargest);
  if (!height) return std::nullopt;
  ModeWish wish{{*width, *height}, std::nullopt};
  if (take_letter(text, '@')) {
    wish.refresh_hz = take_number(text, kLargestHz);
    if (!wish.refresh_hz) return std::nullopt;
  }
  return text.empty() ? std::optional(wish) : std::nullopt;
}

std::optional<Mode> choose_mode(std::span<const Mode> modes, const std::optional<ModeWish>& wish) {
  // Greater is better.
  const auto rank = [&](const Mode& mode) {
    const double off = wish && wish->refresh_hz ? std::abs(mode.refresh_hz - *wish->refresh_hz) : 0;
    return std::tuple(-off, mode.preferred, !mode.interlaced, mode.size.width * mode.size.height,
                      mode.refresh_hz);
  };
  const Mode* best = nullptr;
  for (const Mode& mode : modes) {
    const bool fits =
        !wish ||
        (mode.size == wish->size &&
         (!wish->refresh_hz || std::abs(mode.refresh_hz - *wish->refresh_hz) <= kRateMargin));
    if (fits && (best == nullptr || rank(mode) > rank(*best))) best = &mode;
  }
  return best == nullptr ? std::nullopt : std::optional(*best);
}

std::string name_of(const Mode& mode) {
  return name_of(mode.size) + (mode.interlaced ? "i" : "") + rate_of(mode.refresh_hz);
}

std::string names_of(std::span<const Mode> modes) {
  std::vector<std::string> said;
  std::string all;
  for (const Mode& mode : modes) {
    const std::string name = name_of(mode);
    if (std::ranges::find(said, name) != said.end()) continue;
    all += (said.empty() ? "" : ", ") + name;
    said.push_back(name);
  }
  return all;
}

std::string name_of(const std::optional<ModeWish>& wish) {
  if (!wish) return {};
  return name_of(wish->size) + (wish->refresh_hz ? rate_of(*wish->refresh_hz) : "");
}

}  // namespace lumibox::hal::kms
