#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/gestures.h"
#include "app/moment.h"
#include "app/picture.h"
#include "app/recorder.h"
#include "config/config.h"
#include "render/live_quality.h"

namespace lumibox::app {

/// The last capture before the box was switched on, which has not been gone on with yet.
struct WaitingCapture {
  std::string name;
  std::string problem;  ///< why it cannot be gone on with; empty: it can
};

/// What the modes share.
struct Session {
  const config::Config& config;
  std::filesystem::path captures;  ///< folder in which each capture gets a folder of its own
  Recorder& recorder;
  double threshold = 0.0;                                ///< of the gate, radians
  std::optional<WaitingCapture> waiting = std::nullopt;  ///< in the recorder already
  bool figures = false;                                  ///< how the box is doing is on the screen
  render::CaptureQuality quality = {};                   ///< of the light field, as far as known
};

enum class ModeId { Acquire, Subject, Capture, Review, Resume };

/// One thing the box can be doing. The box is in exactly one mode; a mode names the next by
/// returning it, itself to stay. docs/using.md has the table of what each button does when.
class Mode {
 public:
  virtual ~Mode() = default;

  /// The box comes into this mode.
  virtual void enter(const Moment&) {}

  virtual ModeId press(const Gesture& gesture, const Moment& moment) = 0;

  /// Once per tick, after the buttons.
  virtual ModeId update(const Moment& moment) = 0;

  /// True if the moment's picture should be recorded into the light field.
  virtual bool wants_to_record(const Moment&) const { return false; }

  /// True while new views are recorded as they come.
  virtual bool is_recording() const { return false; }

  virtual Picture draw(const Moment& moment) const = 0;
};

/// Steps of + and −: a long press counts for five; 0 for other buttons.
int steps_of(const Gesture& gesture);

/// "83 views  gate 4.0°"
std::string views_and_gate(const Session& session);

/// "likeness 27.4 dB of 61"; empty as long as nothing is judged.
std::string likeness(const Session& session);

/// What the person should do for the tracking to be good; empty if it is.
std::string tracking_advice(const tracking::TrackedFrame& tracked);

}  // namespace lumibox::app
