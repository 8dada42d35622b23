#pragma once

#include "app/modes/mode.h"

namespace lumibox::app {

/// After the box was switched on: the last capture is there, and the box waits to see what it
/// shows. Goes on with it by itself then, in the world it was recorded in; a new world begins only
/// where the person asks for one.
class ResumeMode : public Mode {
 public:
  explicit ResumeMode(Session& session) : session_(session) {}

  ModeId press(const Gesture& gesture, const Moment& moment) override;
  ModeId update(const Moment& moment) override;
  Picture draw(const Moment& moment) const override;

 private:
  Session& session_;
};

}  // namespace lumibox::app
