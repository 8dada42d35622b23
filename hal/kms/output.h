#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "hal/kms/card.h"

namespace lumibox::hal::kms {

/// A screen and how it is driven.
struct Output {
  Pipe pipe;
  std::string name;  ///< of its connector
  Mode mode;
};

/// The first connected screen that some scanout engine can drive. In the mode wished for, if it has
/// that; else in the one it prefers. None if there is no screen.
std::optional<Output> choose_output(std::span<const Connector> connectors,
                                    const std::optional<ModeWish>& wish);

/// What was found behind the name of a card.
struct CardFound {
  std::string path;                   ///< /dev/dri/card0
  int error = 0;                      ///< errno of opening it
  bool sets_modes = false;            ///< false: it only renders
  std::vector<Connector> connectors;  ///< probed
};

/// Index of the first card with a screen that can be driven, or of the one asked for. Throws
/// config::Unavailable if there is no such card or no screen, and config::InputError if what is
/// missing is permission or, on that screen, the mode wished for.
std::size_t choose_card(std::span<const CardFound> cards, std::string_view asked_for,
                        const std::optional<ModeWish>& wish);

/// The format of pixels (a fourcc) that both the screen shows and GL draws; the earlier in `drawn`
/// the better. None if there is none.
std::optional<std::uint32_t> choose_format(std::span<const std::uint32_t> shown,
                                           std::span<const std::uint32_t> drawn);

}  // namespace lumibox::hal::kms
