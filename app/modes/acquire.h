#pragma once

#include "app/modes/mode.h"

namespace lumibox::app {

/// The box looks for a first map (thesis 2.1) and says how to help it. Goes on by itself.
class AcquireMode : public Mode {
 public:
  ModeId press(const Gesture& gesture, const Moment& moment) override;
  ModeId update(const Moment& moment) override;
  Picture draw(const Moment& moment) const override;
};

}  // namespace lumibox::app
