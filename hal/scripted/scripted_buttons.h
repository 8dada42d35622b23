#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hal/buttons.h"
#include "hal/clock.h"

namespace lumibox::hal {

/// Buttons pressed by a script, whose times count from when these buttons are made: each event
/// becomes visible, with the time on the clock, when the clock reaches it.
class ScriptedButtons : public Buttons {
 public:
  ScriptedButtons(std::vector<ButtonEvent> events, const Clock& clock);

  std::vector<ButtonEvent> poll() override;
  std::optional<std::string> error() const override { return std::nullopt; }

 private:
  std::vector<ButtonEvent> events_;  ///< by time
  const Clock& clock_;
  std::size_t next_ = 0;
};

}  // namespace lumibox::hal
