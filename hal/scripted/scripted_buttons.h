#pragma once

#include <cstddef>
#include <vector>

#include "hal/buttons.h"
#include "hal/clock.h"

namespace lumibox::hal {

/// Buttons pressed by a script: each event becomes visible when the clock reaches its time.
class ScriptedButtons : public Buttons {
 public:
  ScriptedButtons(std::vector<ButtonEvent> events, const Clock& clock);

  std::vector<ButtonEvent> poll() override;

 private:
  std::vector<ButtonEvent> events_;  ///< by time
  const Clock& clock_;
  std::size_t next_ = 0;
};

}  // namespace lumibox::hal
