#include <fmt/core.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/attempts.h"
#include "app/auto_capture.h"
#include "app/commands/commands.h"
#include "app/commands/recorded.h"
#include "app/commands/support.h"
#include "app/progress.h"
#include "app/saved_capture.h"
#include "app/sight.h"
#include "app/threading.h"
#include "app/track_picture.h"
#include "app/track_report.h"
#include "bench/pose_log.h"
#include "bench/track_plot.h"
#include "bench/trajectory.h"
#include "config/error.h"
#include "config/log.h"
#include "hal/replay/replay_camera.h"
#include "hal/system_clock.h"
#include "lightfield/capture_lock.h"
#include "lightfield/transforms.h"

namespace lumibox::app {
namespace {

struct Result {
  TrackReport report;
  bench::PoseLog poses;
  std::vector<bench::PlottedFrame> frames;
};

/// Until the recording is over: look, note, let the capture see it too.
void play(Sight& sight, hal::Camera& camera, hal::Clock& clock, AutoCapture* capture,
          std::int64_t frames, Result& result) {
  constexpr std::int64_t kPollNs = 1'000'000;
  Progress progress("tracking", frames);
  while (true) {
    const Moment& moment = sight.look();
    if (!moment.fresh) {
      if (camera.state() == hal::CameraState::Ended) {
        return;
      }
      clock.wait_until(clock.now_ns() + kPollNs);
      continue;
    }
    result.report.add(moment);
    result.poses.add(moment.tracked);
    result.frames.push_back({1e-9 * static_cast<double>(moment.tracked.timestamp_ns),
                             moment.tracked.state, moment.tracked.reason,
                             moment.tracked.measurements, moment.tracking_ms});
    if (capture != nullptr) {
      capture->see(moment);
    }
    progress.show(result.report.frames());
  }
}

/// Adds the errors against the truth to the statistics and says them, if there are enough poses to
/// compare.
void judge(const std::string& which, const std::vector<hal::StampedPose>& trajectory,
           const hal::Sequence& sequence, nlohmann::json& json) {
  const auto subject = sequence.subject ? std::optional(sequence.subject->center) : std::nullopt;
  const auto error = bench::compare_trajectories(trajectory, sequence.ground_truth, subject);
  if (!error) {
    return;
  }
  json["ate_" + which] = error->rmse;
  std::string share = "of an extent that is zero";
  if (error->rmse_percent) {
    json["ate_" + which + "_percent"] = *error->rmse_percent;
    share = fmt::format("{:.3f} % of the extent", *error->rmse_percent);
  }
  json["rotation_rmse_deg_" + which] = error->rotation_rmse_deg;
  std::printf("%-5s error over %d poses: %.5f, %s (RMSE after Sim(3) alignment); rotation %.3f deg",
              which.c_str(), error->poses, error->rmse, share.c_str(), error->rotation_rmse_deg);
  if (error->subject_rmse_deg) {
    json["subject_rmse_deg_" + which] = *error->subject_rmse_deg;
    std::printf(", %.3f deg at the subject", *error->subject_rmse_deg);
  }
  std::printf("\n");
}

void say(const TrackReport& report, const nlohmann::json& json) {
  std::printf("%lld frames, %lld tracked", static_cast<long long>(report.frames()),
              static_cast<long long>(report.tracked()));
  if (const auto first = report.initialised_at_frame()) {
    std::printf(" from frame %lld on", static_cast<long long>(*first));
  }
  std::printf("; %d keyframes, %d points; %.1f ms median, %.1f ms p95\n",
              json["keyframes"].get<int>(), json["points"].get<int>(),
              json["ms"]["median"].get<double>(), json["ms"]["p95"].get<double>());
  for (const Loss& loss : report.losses()) {
    std::printf("lost in frames %lld to %lld: %s\n", static_cast<long long>(loss.first_frame),
                static_cast<long long>(loss.last_frame), name_of(loss.reason).c_str());
  }
}

/// True if the capture to be made is the one that is gone on with.
bool goes_on_with_capture(const TrackOptions& options) {
  std::error_code ignored;
  return options.capture && options.resume &&
         std::filesystem::equivalent(*options.capture, *options.resume, ignored);
}

/// What --resume names; throws config::InputError if there is no going on in it.
std::optional<SavedCapture> load_saved(const TrackOptions& options, const geometry::Camera& camera,
                                       int levels) {
  if (!options.resume) {
    return std::nullopt;
  }
  std::optional<lightfield::CaptureLock> lock;
  if (goes_on_with_capture(options)) {
    lock.emplace(*options.resume);
  }
  SavedCapture saved = load_saved_capture(*options.resume, camera, levels);
  if (!saved.problem.empty()) {
    throw config::InputError("--resume: " + saved.problem);
  }
  saved.lock = std::move(lock);
  if (goes_on_with_capture(options)) {
    subject_of(saved.capture);  // or the gate would have nothing to go by
    if (options.subject) {
      throw config::InputError("--subject: " + options.resume->string() +
                               " is gone on with and has its subject; expected none");
    }
  }
  return saved;
}

/// The files that results go into.
std::vector<std::filesystem::path> results_of(const TrackOptions& options) {
  std::vector<std::filesystem::path> files = {options.out};
  for (const auto& file : {options.live, options.json, options.plot}) {
    if (file) files.push_back(*file);
  }
  return files;
}

/// Nothing that was recorded, or is about to be, may lie where a result goes.
void refuse_recorded_places(const TrackOptions& options, const hal::Sequence& sequence) {
  for (const auto& result : results_of(options)) {
    for (const auto& capture : {options.capture, options.resume}) {
      if (capture) refuse_inside(result, *capture);
    }
    refuse_recorded(result);
    refuse_recorded(result, sequence);
  }
  if (options.capture) refuse_recorded(*options.capture);
}

/// An hour of tracking must not end at a mistyped folder. The lock of a new capture's.
std::optional<lightfield::CaptureLock> try_outputs(const TrackOptions& options) {
  const std::vector<std::filesystem::path> files = results_of(options);
  require_distinct(files);
  std::optional<lightfield::CaptureLock> lock;
  if (options.capture && !goes_on_with_capture(options)) {
    lock = lightfield::make_capture_folder({}, *options.capture);
  }
  for (const auto& file : files) require_writable(file);
  return lock;
}

/// How many perspectives of a capture are on disk.
std::size_t kept_in(const std::filesystem::path& capture) {
  try {
    const auto file = capture / lightfield::kTransformsFile;
    return lightfield::read_transforms(file, lightfield::Dialect::Capture).perspectives.size();
  } catch (const config::InputError&) {
    return 0;
  }
}

/// Brings the capture to disk and says what it came to, also if not all of it got there.
void finish_capture(const std::filesystem::path& folder, Recorder& recorder,
                    const tracking::Tracker& tracker, nlohmann::json& json) {
  Attempts attempts;
  attempts.attempt([&] { recorder.finish(map_of(tracker)); });
  const std::size_t recorded = recorder.light_field().perspectives().size();
  const std::size_t kept = kept_in(folder);
  json["perspectives"] = kept;
  if (!recorder.light_field().subject()) {
    config::log_warning(folder.string() +
                        ": no capture: no frame was tracked well enough to place the subject");
  } else if (kept == recorded) {
    std::printf("%zu perspectives in %s\n", kept, folder.c_str());
  } else {
    std::printf("%zu of %zu perspectives in %s\n", kept, recorded, folder.c_str());
  }
  attempts.rethrow();
}

}  // namespace

void track(const TrackOptions& options) {
  const config::Config config = load_config(options.sources);
  const hal::Sequence sequence = hal::open_sequence(options.sequence, options.calibration);
  const Threading threading = options.realtime ? kThreaded : kLockstep;
  const geometry::Camera model(sequence.profile);
  if (options.subject && !model.contains(options.subject->pixel)) {
    throw config::InputError("--subject: the pixel lies outside the pictures of " +
                             std::to_string(model.width()) + "x" + std::to_string(model.height()));
  }
  const auto frames = static_cast<std::int64_t>(sequence.entries.size());
  if (options.subject && options.subject->frame >= frames) {
    throw config::InputError("--subject: frame " + std::to_string(options.subject->frame) +
                             "; the recording has " + std::to_string(frames) + ", from 0");
  }
  refuse_recorded_places(options, sequence);
  auto saved = load_saved(options, model, config.tracking.pyramid_levels);
  const auto lock = try_outputs(options);
  hal::SystemClock clock;
  hal::ReplayCamera camera(sequence, clock,
                           options.realtime ? hal::Pacing::Recorded : hal::Pacing::Lockstep);
  tracking::Tracker tracker(model, config.tracking, threading.mapping, options.seed,
                            saved ? saved->map : nullptr);
  Sight sight(camera, clock, tracker);
  Recorder recorder(model, config.capture, threading.writing);
  if (goes_on_with_capture(options)) {
    recorder.resume(std::move(saved->capture), &sight.moment().map);
  }
  std::optional<AutoCapture> capture;
  if (options.capture) {
    capture.emplace(recorder, model, config.capture, *options.capture, options.subject);
  }

  camera.start();
  Result result;
  Attempts attempts;  // whatever goes wrong, all that was tracked before it is kept
  attempts.attempt(
      [&] { play(sight, camera, clock, capture ? &*capture : nullptr, frames, result); });
  tracker.finish();
  attempts.attempt([&] {
    if (const auto error = tracker.mapping_error()) {
      throw std::runtime_error("mapping ended: " + *error);
    }
  });

  nlohmann::json json = result.report.to_json(tracker.statistics());
  if (capture) {
    attempts.attempt([&] { finish_capture(*options.capture, recorder, tracker, json); });
  }
  const auto live = result.poses.live();
  const auto corrected = result.poses.corrected(tracker);
  attempts.attempt([&] { hal::write_tum_trajectory(options.out, corrected); });
  if (options.live) {
    attempts.attempt([&] { hal::write_tum_trajectory(*options.live, live); });
  }
  say(result.report, json);
  judge("live", live, sequence, json);
  judge("final", corrected, sequence, json);
  if (corrected.size() >= 3 && !sequence.ground_truth.empty() && !json.contains("ate_final")) {
    config::log_warning(
        fmt::format("{}: fewer than three poses have a true pose within 0.02 s of their time; no "
                    "errors are said",
                    (sequence.path / "groundtruth.txt").string()));
  }
  if (options.json) {
    attempts.attempt([&] { write_json(*options.json, json); });
  }
  if (options.plot) {
    attempts.attempt([&] {
      bench::TrackPlot plot = begin_plot(tracker, sequence, json);
      plot.frames = result.frames;
      plot.live = live;
      plot.corrected = corrected;
      for (const auto& perspective : recorder.light_field().perspectives()) {
        plot.perspectives.push_back(perspective.world_from_camera.translation);
      }
      bench::write_svg(*options.plot, bench::draw_track(plot));
    });
  }
  attempts.rethrow();
  if (result.poses.empty()) {
    throw config::InputError(options.sequence, std::string("no frame could be tracked: ") +
                                                   tracking::advice(result.report.last_reason()));
  }
}

}  // namespace lumibox::app
