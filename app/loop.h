#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/devices.h"
#include "app/gestures.h"
#include "app/lamp.h"
#include "app/metronome.h"
#include "app/modes/modes.h"
#include "app/recorder.h"
#include "app/saved_capture.h"
#include "app/screen.h"
#include "app/sight.h"
#include "app/threading.h"
#include "config/config.h"
#include "tracking/tracker.h"

namespace lumibox::app {

/// What a run came to.
struct LoopStatistics {
  std::int64_t ticks = 0;
  std::int64_t late_ticks = 0;
  std::int64_t frames = 0;
  std::int64_t tracked = 0;  ///< frames with a pose
};

/// The appliance: everything that happens, happens in tick().
class Loop {
 public:
  /// `devices` must outlive the loop; captures become folders of their own in `captures`. If a
  /// capture is `saved`, it can be gone on with.
  Loop(Devices& devices, const config::Config& config, std::filesystem::path captures,
       Threading threading, std::optional<SavedCapture> saved = std::nullopt);

  /// Has this shown among the alerts of every picture.
  void always_show(std::string alert) { standing_alerts_.push_back(std::move(alert)); }

  /// Ticks at the configured rate as long as `go_on` says so after each.
  void run(const std::function<bool()>& go_on);

  /// The same, then finish(), also when a tick throws: what is recorded by then is kept. `over` is
  /// called between the two, since the latter takes a while.
  void run_and_finish(
      const std::function<bool()>& go_on, const std::function<void()>& over = [] {});

  void tick();

  /// Brings the capture under way to disk: final corrections, points, pictures. Throws
  /// config::InputError if something could not be written, std::runtime_error if mapping ended.
  void finish();

  ModeId mode() const { return modes_.current(); }
  const Moment& moment() const { return sight_.moment(); }
  const Picture& picture() const { return picture_; }
  const Recorder& recorder() const { return recorder_; }
  const config::Config& config() const { return config_; }
  LoopStatistics statistics() const;

 private:
  void resume(SavedCapture saved);
  const Moment& look();
  void hold_exposure(bool hold);
  void record(const Moment& moment);
  void light(const Decision& decision, const Moment& moment);
  void show(Picture picture);
  std::vector<std::string> figures() const;

  Devices& devices_;
  config::Config config_;
  geometry::Camera camera_;
  tracking::Tracker tracker_;
  Sight sight_;
  Recorder recorder_;
  Session session_;
  Modes modes_;
  Gestures gestures_;
  Metronome metronome_;
  Screen screen_;
  render::LiveQuality quality_;
  Picture picture_;
  std::vector<std::string> standing_alerts_;
  bool exposure_held_ = false;
  Lamp lamp_;
  double work_ms_ = 0.0;  ///< of the tick before
  LoopStatistics statistics_;
};

}  // namespace lumibox::app
