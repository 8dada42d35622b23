#include "bench/tracking_bench.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <thread>

#include "bench/pose_log.h"
#include "bench/stopwatch.h"
#include "bench/trajectory.h"
#include "tracking/tracker.h"

namespace lumibox::bench {
namespace {

constexpr int kOrbFeatures = 1000;
constexpr std::size_t kOrbStep = 10;   // frames
constexpr double kOrbTarget = 0.6;     // of ORB's time that a frame of the tracker may take
constexpr double kMedianTarget = 5.0;  // ms of the tracker alone
constexpr double kP95Target = 10.0;    // ms

void await_mapper(const tracking::Tracker& tracker) {
  while (tracker.mapping()) std::this_thread::sleep_for(std::chrono::microseconds(200));
}

std::optional<Accuracy> accuracy(const std::vector<hal::StampedPose>& trajectory,
                                 const std::vector<hal::StampedPose>& truth) {
  const auto error = compare_trajectories(trajectory, truth);
  if (!error || !error->rmse_percent) return std::nullopt;
  return Accuracy{*error->rmse_percent, error->rotation_rmse_deg};
}

nlohmann::json to_json(const std::optional<Accuracy>& accuracy) {
  if (!accuracy) return nullptr;
  return {{"percent", accuracy->percent}, {"rotation_deg", accuracy->rotation_deg}};
}

nlohmann::json result_to_json(const char* what, const Footage& footage,
                              const TrackingResult& result) {
  return {{"what", what},
          {"footage", footage.name},
          {"frames", result.frames},
          {"tracked", result.tracked},
          {"keyframes", result.keyframes},
          {"points", result.points},
          {"ms", to_json(result.wall_ms)},
          {"cpu_ms", to_json(result.cpu_ms)},
          {"initialising_ms", to_json(result.initialising_ms)},
          {"mapping_ms", result.mapping_ms},
          {"refinement_ms", result.refinement_ms},
          {"error_live", to_json(result.live)},
          {"error_unrefined", to_json(result.unrefined)},
          {"error_final", to_json(result.refined)}};
}

}  // namespace

TrackingResult measure_tracking(const Footage& footage, const config::Tracking& options, Pace pace,
                                std::uint32_t seed) {
  using Clock = std::chrono::steady_clock;
  tracking::Tracker tracker(footage.camera, options, tracking::Mapping::Threaded, seed);
  TrackingResult result;
  PoseLog poses;
  Samples samples;
  Samples initialising;
  const auto start = Clock::now();
  for (std::size_t i = 0; i < footage.frames.size(); ++i) {
    const Footage::Frame& frame = footage.frames[i];
    if (pace == Pace::Recorded) {
      std::this_thread::sleep_until(
          start +
          std::chrono::nanoseconds(frame.timestamp_ns - footage.frames.front().timestamp_ns));
    }
    const Stopwatch frame_watch;
    const auto tracked =
        tracker.track(*frame.gray, static_cast<std::int64_t>(i), frame.timestamp_ns);
    const bool has_map = tracked.state != tracking::TrackingState::Initialising;
    (has_map ? samples : initialising).add(frame_watch);
    ++result.frames;
    if (tracked.world_from_camera) ++result.tracked;
    poses.add(tracked);
    const Stopwatch mapper_watch;
    if (pace == Pace::Awaited) await_mapper(tracker);
    result.mapping_ms += mapper_watch.wall_ms();
  }
  await_mapper(tracker);
  result.live = accuracy(poses.live(), footage.truth);
  result.unrefined = accuracy(poses.corrected(tracker), footage.truth);
  const Stopwatch refinement_watch;
  tracker.finish();
  result.refinement_ms = refinement_watch.wall_ms();
  result.refined = accuracy(poses.corrected(tracker), footage.truth);
  const tracking::TrackerStatistics statistics = tracker.statistics();
  result.keyframes = statistics.keyframes;
  result.points = statistics.points;
  result.wall_ms = summary(samples.wall_ms);
  result.cpu_ms = summary(samples.cpu_ms);
  result.initialising_ms = summary(initialising.wall_ms);
  return result;
}

OrbResult measure_orb(const Footage& footage) {
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const cv::Ptr<cv::ORB> orb = cv::ORB::create(kOrbFeatures);
  Samples samples;
  for (std::size_t i = 0; i < footage.frames.size(); i += kOrbStep) {
    const hal::Image& gray = *footage.frames[i].gray;
    const cv::Mat picture(gray.height(), gray.width(), CV_8UC1,
                          const_cast<std::uint8_t*>(gray.data()));  // cv::Mat knows no const
    std::vector<cv::KeyPoint> corners;
    cv::Mat descriptors;
    const Stopwatch watch;
    orb->detectAndCompute(picture, cv::noArray(), corners, descriptors);
    samples.add(watch);
  }
  cv::setNumThreads(threads);
  return {summary(samples.wall_ms), summary(samples.cpu_ms)};
}

nlohmann::json to_json(const Footage& footage, const Variation& variation, std::uint32_t seed,
                       const TrackingResult& result) {
  nlohmann::json json = result_to_json("tracking", footage, result);
  json["setting"] = variation.setting;
  json["value"] = variation.value;
  json["default"] = variation.is_default;
  json["seed"] = seed;
  return json;
}

nlohmann::json realtime_to_json(const Footage& footage, const TrackingResult& result) {
  nlohmann::json json = result_to_json("tracking_realtime", footage, result);
  json["target_ms"] = {{"median", kMedianTarget}, {"p95", kP95Target}};
  return json;
}

nlohmann::json to_json(const Footage& footage, const OrbResult& orb,
                       const TrackingResult& tracker) {
  return {{"what", "orb"},
          {"footage", footage.name},
          {"features", kOrbFeatures},
          {"ms", to_json(orb.wall_ms)},
          {"cpu_ms", to_json(orb.cpu_ms)},
          {"tracker_over_orb", tracker.wall_ms.median / orb.wall_ms.median},
          {"tracker_over_orb_cpu", tracker.cpu_ms.median / orb.cpu_ms.median},
          {"target", kOrbTarget}};
}

}  // namespace lumibox::bench
