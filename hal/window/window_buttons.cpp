#include "hal/window/window_buttons.h"

#include <utility>

namespace lumibox::hal {

WindowButtons::WindowButtons(std::shared_ptr<KeyEdges> keys, const config::Evdev& options,
                             double stuck_s, const Clock& clock)
    : keys_(std::move(keys)), clock_(clock), held_(key_map(options)), guard_(stuck_s) {}

std::vector<ButtonEvent> WindowButtons::poll() {
  std::vector<ButtonEvent> edges;
  for (const KeyEdge& key : std::exchange(*keys_, {})) {
    if (const auto edge = held_.take(key.code, key.down, key.timestamp_ns)) edges.push_back(*edge);
  }
  return guard_.pass(edges, clock_.now_ns());
}

}  // namespace lumibox::hal
