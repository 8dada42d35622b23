#include "hal/hold_guard.h"

#include <algorithm>
#include <cmath>

#include "config/log.h"

namespace lumibox::hal {

HoldGuard::HoldGuard(double stuck_s)
    : stuck_ns_(static_cast<std::int64_t>(std::llround(stuck_s * 1e9))) {}

void HoldGuard::held_at_start(Button button, std::int64_t now_ns) {
  holds_.at(index_of(button)) = Hold{.since_ns = now_ns, .heard = false};
}

std::vector<ButtonEvent> HoldGuard::pass(const std::vector<ButtonEvent>& edges,
                                         std::int64_t now_ns) {
  std::vector<ButtonEvent> heard;
  for (const ButtonEvent& edge : edges) {
    std::optional<Hold>& hold = holds_.at(index_of(edge.button));
    if (edge.action == ButtonAction::Pressed) {
      hold = Hold{.since_ns = edge.timestamp_ns};
      heard.push_back(edge);
    } else if (hold) {
      if (hold->heard) {
        heard.push_back(edge);
      }
      hold.reset();
    }
  }
  const std::vector<ButtonEvent> stuck = newly_stuck(now_ns);
  heard.insert(heard.end(), stuck.begin(), stuck.end());
  std::ranges::stable_sort(heard, {}, &ButtonEvent::timestamp_ns);
  return heard;
}

/// The releases that no finger will make.
std::vector<ButtonEvent> HoldGuard::newly_stuck(std::int64_t now_ns) {
  std::vector<ButtonEvent> releases;
  for (const Button button : kAllButtons) {
    std::optional<Hold>& hold = holds_.at(index_of(button));
    if (!hold || hold->stuck || now_ns - hold->since_ns < stuck_ns_) {
      continue;
    }
    if (hold->heard) {
      releases.push_back({button, ButtonAction::Released, hold->since_ns + stuck_ns_});
    }
    hold->heard = false;
    hold->stuck = true;
    config::log_warning("the button " + name_of(button) +
                        " is stuck; it is not heard until it is released");
  }
  return releases;
}

std::optional<std::string> HoldGuard::error() const {
  std::string stuck;
  for (const Button button : kAllButtons) {
    const std::optional<Hold>& hold = holds_.at(index_of(button));
    if (hold && hold->stuck) {
      stuck += (stuck.empty() ? "" : ", ") + name_of(button);
    }
  }
  return stuck.empty() ? std::nullopt : std::optional("stuck: " + stuck);
}

}  // namespace lumibox::hal
