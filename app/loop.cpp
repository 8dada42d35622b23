#include "app/loop.h"

#include <fmt/core.h>

#include <numbers>
#include <stdexcept>
#include <utility>

#include "app/attempts.h"

namespace lumibox::app {
namespace {

std::optional<WaitingCapture> waiting(const std::optional<SavedCapture>& saved) {
  return saved ? std::optional(WaitingCapture{saved->name(), saved->problem}) : std::nullopt;
}

}  // namespace

Loop::Loop(Devices& devices, const config::Config& config, std::filesystem::path captures,
           Threading threading, std::optional<SavedCapture> saved)
    : devices_(devices),
      config_(config),
      camera_(devices.camera->profile()),
      tracker_(camera_, config.tracking, threading.mapping, /*seed=*/0,
               saved ? saved->map : nullptr),
      sight_(*devices.camera, *devices.clock, tracker_),
      recorder_(camera_, config.capture, threading.writing),
      session_{config_, std::move(captures), recorder_,
               config.capture.threshold_deg * std::numbers::pi / 180.0, waiting(saved)},
      modes_(session_, camera_),
      gestures_(config.controls.long_press_s),
      metronome_(*devices.clock, config.loop.rate_hz),
      screen_(*devices.display, *devices.clock, camera_, config.render, threading.estimating),
      quality_(config.render, config.quality, threading.estimating) {
  if (saved) {
    resume(std::move(*saved));
  }
}

void Loop::resume(SavedCapture saved) {
  session_.threshold = saved.capture.threshold.value_or(session_.threshold);
  recorder_.resume(std::move(saved.capture), saved.map ? &sight_.moment().map : nullptr);
}

void Loop::run(const std::function<bool()>& go_on) {
  do {
    tick();
    metronome_.wait();
  } while (go_on());
}

void Loop::run_and_finish(const std::function<bool()>& go_on, const std::function<void()>& over) {
  Attempts attempts;
  attempts.attempt([&] { run(go_on); });
  attempts.attempt(over);
  attempts.attempt([&] { finish(); });
  attempts.rethrow();
}

void Loop::tick() {
  const std::int64_t begin_ns = devices_.clock->now_ns();
  const Moment& moment = look();
  const auto gestures = gestures_.update(devices_.buttons->poll(), moment.now_ns);
  const Decision decision = modes_.decide(gestures, moment);
  hold_exposure(decision.hold_exposure);
  if (decision.start_over) {
    recorder_.close(moment.map);
    tracker_.start_over();
  }
  if (decision.record) {
    record(moment);
  }
  light(decision, moment);
  recorder_.keep_map(moment);
  session_.quality = quality_.watch(recorder_.light_field(), moment.map.points);
  show(modes_.draw(moment));
  ++statistics_.ticks;
  work_ms_ = 1e-6 * static_cast<double>(devices_.clock->now_ns() - begin_ns);
}

const Moment& Loop::look() {
  const Moment& moment = sight_.look();
  recorder_.follow_map(moment.map, config_.capture.moved_share);
  if (moment.fresh) {
    ++statistics_.frames;
    statistics_.tracked += moment.tracked.world_from_camera ? 1 : 0;
  }
  return moment;
}

void Loop::hold_exposure(bool hold) {
  if (hold != exposure_held_) {
    devices_.camera->lock_exposure(hold);
    exposure_held_ = hold;
  }
}

void Loop::record(const Moment& moment) {
  recorder_.record(moment);
  screen_.upload(recorder_.light_field().perspectives().back());
}

void Loop::light(const Decision& decision, const Moment& moment) {
  if (devices_.status_led) {
    const bool recording = decision.recording && moment.tracked.world_from_camera.has_value();
    devices_.status_led->light(lamp_.is_lit(recording, decision.record, moment.now_ns));
  }
}

void Loop::show(Picture picture) {
  picture_ = std::move(picture);
  picture_.alerts.insert(picture_.alerts.end(), standing_alerts_.begin(), standing_alerts_.end());
  if (devices_.camera->state() == hal::CameraState::Lost) {
    picture_.alerts.emplace_back("the camera is gone; waiting for it");
  }
  if (const auto error = devices_.buttons->error()) {
    picture_.alerts.push_back("buttons: " + *error);
  }
  if (const auto error = recorder_.error()) {
    picture_.alerts.push_back("not stored: " + *error);
  }
  if (const auto lost = recorder_.light_field().lost_pictures()) {
    picture_.alerts.push_back(*lost);
  }
  if (const auto error = tracker_.mapping_error()) {
    picture_.alerts.push_back("the map no longer grows: " + *error);
  }
  if (session_.figures) {
    picture_.figures = figures();
  }
  screen_.draw(picture_, sight_.moment().frame, metronome_.due_ns());
  screen_.present();
}

std::vector<std::string> Loop::figures() const {
  std::vector<std::string> lines = {
      fmt::format("tick {:.1f} of {:.1f} ms, {} of {} late", work_ms_, 1e3 / config_.loop.rate_hz,
                  metronome_.late_ticks(), statistics_.ticks),
      fmt::format("tracking {:.1f} ms, {} of {} frames", sight_.moment().tracking_ms,
                  statistics_.tracked, statistics_.frames)};
  if (!screen_.viewer_figures().empty()) {
    lines.push_back("review: " + screen_.viewer_figures());
  }
  return lines;
}

void Loop::finish() {
  tracker_.finish();
  recorder_.finish(map_of(tracker_));
  if (const auto error = tracker_.mapping_error()) {
    throw std::runtime_error("mapping ended: " + *error);
  }
}

LoopStatistics Loop::statistics() const {
  LoopStatistics statistics = statistics_;
  statistics.late_ticks = metronome_.late_ticks();
  return statistics;
}

}  // namespace lumibox::app
