#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/buttons.h"

namespace lumibox::hal {

/// Edges of several sets of buttons as those of one: a button is down while any of them holds it.
class ButtonUnion {
 public:
  /// `edges` of all sets since the last call; those of each set in order and alternating.
  std::vector<ButtonEvent> merge(std::vector<ButtonEvent> edges);

 private:
  struct State {
    int holders = 0;           ///< sets in which it is down
    std::int64_t last_ns = 0;  ///< of what was told last: a set may be told of late
  };
  std::array<State, 5> states_;  ///< by Button
};

/// Several sources of buttons as one.
class MergedButtons : public Buttons {
 public:
  explicit MergedButtons(std::vector<std::unique_ptr<Buttons>> sources);

  std::vector<ButtonEvent> poll() override;
  std::optional<std::string> error() const override;

 private:
  std::vector<std::unique_ptr<Buttons>> sources_;
  ButtonUnion union_;
};

/// Errors of several things in one line; none if there is none.
std::optional<std::string> joined(const std::vector<std::optional<std::string>>& errors);

}  // namespace lumibox::hal
