#include "hal/merged_buttons.h"

#include <algorithm>
#include <utility>

namespace lumibox::hal {

std::vector<ButtonEvent> ButtonUnion::merge(std::vector<ButtonEvent> edges) {
  std::ranges::stable_sort(edges, {}, &ButtonEvent::timestamp_ns);
  std::vector<ButtonEvent> merged;
  for (ButtonEvent& edge : edges) {
    State& state = states_.at(index_of(edge.button));
    const bool was_down = state.holders > 0;
    state.holders += edge.action == ButtonAction::Pressed ? 1 : -1;
    if (was_down != (state.holders > 0)) {
      edge.timestamp_ns = std::max(edge.timestamp_ns, state.last_ns);
      state.last_ns = edge.timestamp_ns;
      merged.push_back(edge);
    }
  }
  std::ranges::stable_sort(merged, {}, &ButtonEvent::timestamp_ns);
  return merged;
}

MergedButtons::MergedButtons(std::vector<std::unique_ptr<Buttons>> sources)
    : sources_(std::move(sources)) {}

std::vector<ButtonEvent> MergedButtons::poll() {
  std::vector<ButtonEvent> edges;
  for (const auto& source : sources_) {
    const std::vector<ButtonEvent> more = source->poll();
    edges.insert(edges.end(), more.begin(), more.end());
  }
  return union_.merge(std::move(edges));
}

std::optional<std::string> MergedButtons::error() const {
  std::vector<std::optional<std::string>> errors;
  for (const auto& source : sources_) errors.push_back(source->error());
  return joined(errors);
}

std::optional<std::string> joined(const std::vector<std::optional<std::string>>& errors) {
  std::string all;
  for (const auto& error : errors) {
    if (error) {
      all += (all.empty() ? "" : "; ") + *error;
    }
  }
  return all.empty() ? std::nullopt : std::optional(all);
}

}  // namespace lumibox::hal
