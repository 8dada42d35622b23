#pragma once

#include "app/modes/mode.h"

namespace lumibox::app {

/// Thesis 2.3: while the person paints the sphere with dots, the gate decides what is recorded.
class CaptureMode : public Mode {
 public:
  explicit CaptureMode(Session& session) : session_(session) {}

  void enter(const Moment& moment) override;
  ModeId press(const Gesture& gesture, const Moment& moment) override;
  ModeId update(const Moment& moment) override;
  bool wants_to_record(const Moment& moment) const override;
  Picture draw(const Moment& moment) const override;

 private:
  void change_threshold(int steps);
  void wipe(Press press, const Moment& moment);

  Session& session_;
  bool paused_ = false;
};

}  // namespace lumibox::app
