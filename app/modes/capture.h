#pragma once

#include <string>

#include "app/guide.h"
#include "app/modes/mode.h"
#include "geometry/camera.h"

namespace lumibox::app {

/// Thesis 2.3: while the person paints the sphere with dots, the gate decides what is recorded.
class CaptureMode : public Mode {
 public:
  /// `camera` is the one that records.
  CaptureMode(Session& session, const geometry::Camera& camera);

  void enter(const Moment& moment) override;
  ModeId press(const Gesture& gesture, const Moment& moment) override;
  ModeId update(const Moment& moment) override;
  bool wants_to_record(const Moment& moment) const override;
  bool is_recording() const override { return !paused_; }
  Picture draw(const Moment& moment) const override;

 private:
  std::string title(const Moment& moment) const;
  std::string details() const;
  render::Coverage coverage(const geometry::Pose& world_from_camera) const;
  void change_threshold(int steps);
  void wipe(Press press, const Moment& moment);

  Session& session_;
  double focal_px_;
  Guide guide_;
  lightfield::Holes holes_;
  bool paused_ = false;
};

}  // namespace lumibox::app
