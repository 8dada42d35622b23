#pragma once

#include <array>
#include <memory>
#include <vector>

#include "app/modes/mode.h"

namespace lumibox::app {

/// What the modes make of a moment.
struct Decision {
  bool record = false;         ///< the moment's picture belongs into the light field
  bool hold_exposure = false;  ///< a subject is being captured: its pictures should match
  bool recording = false;      ///< new views are recorded as they come
  bool start_over = false;     ///< the capture that waited and its world are given up
};

/// Acquire → Subject → Capture ⇄ Review, or from Resume to Capture: the mode the box is in, and the
/// way from one to the next.
class Modes {
 public:
  /// `session` must outlive the object.
  Modes(Session& session, const geometry::Camera& camera);

  Decision decide(const std::vector<Gesture>& gestures, const Moment& moment);

  Picture draw(const Moment& moment) const { return mode(current_).draw(moment); }

  ModeId current() const { return current_; }

 private:
  Mode& mode(ModeId id) const { return *modes_.at(static_cast<std::size_t>(id)); }
  bool asks_for_figures(const Gesture& gesture) const;
  void go_to(ModeId next, const Moment& moment);

  Session& session_;
  std::array<std::unique_ptr<Mode>, 5> modes_;  ///< by ModeId
  ModeId current_;
  bool start_over_ = false;
};

}  // namespace lumibox::app
