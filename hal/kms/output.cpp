#include "hal/kms/output.h"

#include <algorithm>
#include <cerrno>

#include "config/error.h"
#include "config/error_text.h"

namespace lumibox::hal::kms {
namespace {

bool usable(const Connector& connector) {
  return connector.connected && !connector.modes.empty() && !connector.crtcs.empty();
}

const Connector* first_usable(std::span<const Connector> connectors) {
  const auto found = std::ranges::find_if(connectors, usable);
  return found == connectors.end() ? nullptr : &*found;
}

bool is_denied(const CardFound& card) {
  return card.error == EACCES || card.error == EPERM;
}

/// Why there is no picture to be had from this card; empty if there is.
std::string fault_of(const CardFound& card) {
  if (is_denied(card)) {
    return "permission denied; expected a user in the groups video and render";
  }
  if (card.error != 0) {
    return config::error_text(card.error) + "; expected a graphics card";
  }
  if (!card.sets_modes) return "drives no screens; expected a card that sets modes";
  if (first_usable(card.connectors) != nullptr) return {};
  std::string sockets;
  for (const Connector& connector : card.connectors) {
    sockets += (sockets.empty() ? "" : ", ") + connector.name;
  }
  return "no screen is connected; expected one at " + (sockets.empty() ? "a socket" : sockets);
}

void require_mode(const CardFound& card, const std::optional<ModeWish>& wish) {
  const Connector& screen = *first_usable(card.connectors);
  if (choose_mode(screen.modes, wish)) return;
  throw config::InputError("display kms:" + card.path + ": the screen at " + screen.name +
                           " has no mode " + name_of(wish) + " (display.mode); expected one of " +
                           names_of(screen.modes));
}

}  // namespace

std::optional<Output> choose_output(std::span<const Connector> connectors,
                                    const std::optional<ModeWish>& wish) {
  const Connector* screen = first_usable(connectors);
  if (screen == nullptr) return std::nullopt;
  std::optional<Mode> mode = choose_mode(screen->modes, wish);
  if (!mode) mode = choose_mode(screen->modes, std::nullopt);
  return Output{{screen->crtcs.front(), screen->id}, screen->name, *mode};
}

std::size_t choose_card(std::span<const CardFound> cards, std::string_view asked_for,
                        const std::optional<ModeWish>& wish) {
  std::string faults;
  bool denied = false;
  for (std::size_t i = 0; i < cards.size(); ++i) {
    if (!asked_for.empty() && cards[i].path != asked_for) continue;
    const std::string fault = fault_of(cards[i]);
    if (fault.empty()) {
      require_mode(cards[i], wish);
      return i;
    }
    faults += (faults.empty() ? "" : "; ") + cards[i].path + ": " + fault;
    denied = denied || is_denied(cards[i]);
  }
  if (denied) throw config::InputError("display kms: " + faults);
  throw config::Unavailable("display kms: " +
                            (faults.empty() ? "no card; expected one in /dev/dri" : faults));
}

std::optional<std::uint32_t> choose_format(std::span<const std::uint32_t> shown,
                                           std::span<const std::uint32_t> drawn) {
  const auto both = std::ranges::find_if(
      drawn, [&](std::uint32_t format) { return std::ranges::find(shown, format) != shown.end(); });
  return both == drawn.end() ? std::nullopt : std::optional(*both);
}

}  // namespace lumibox::hal::kms
