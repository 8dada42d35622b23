#include "tracking/keyframe_chooser.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace lumibox::tracking {
namespace {

constexpr int kMinKeyframeGap = 4;             // frames
constexpr std::size_t kMaxEvidence = 100000;   // about a hundred frames' worth
constexpr double kRefreshShare = 0.5;          // of the nearest keyframe's points still measured
constexpr double kMinRefreshBaseline = 0.012;  // of the depth: without a baseline, no new points

}  // namespace

double wanted_baseline(const config::Tracking& options) {
  return std::tan(options.keyframe_parallax_deg * std::numbers::pi / 180.0);
}

KeyframeChooser::KeyframeChooser(const geometry::Camera& camera, const config::Tracking& options)
    : camera_(camera), options_(options) {
  reserve_evidence();
}

void KeyframeChooser::reserve_evidence() {
  evidence_.reserve(kMaxEvidence + static_cast<std::size_t>(options_.max_measurements));
}

void KeyframeChooser::note(const MapView& map, const Localisation& found) {
  inliers_.clear();
  for (const Measurement& m : found.measurements) {
    if (m.inlier) inliers_.push_back(m.point);
  }
  std::sort(inliers_.begin(), inliers_.end());
  // A camera that stands still asks for no keyframe, for hours perhaps: the older half is dropped.
  if (evidence_.size() > kMaxEvidence) {
    evidence_.erase(evidence_.begin(), evidence_.begin() + kMaxEvidence / 2);
  }
  for (const std::uint32_t point : found.attempted) {
    evidence_.push_back(
        {map.points[point].id, std::binary_search(inliers_.begin(), inliers_.end(), point)});
  }
}

bool KeyframeChooser::is_wanted(const MapView& map, const Anchor& anchor,
                                const Localisation& found) const {
  const MapView::Keyframe& nearest = map.keyframes[static_cast<std::size_t>(anchor.keyframe)];
  const double baseline =
      nearest.scale * anchor.keyframe_from_camera.translation.norm() / found.median_depth;
  const bool parallax = baseline > wanted_baseline(options_);
  const bool refresh =
      found.inliers < kRefreshShare * std::min(nearest.points, options_.max_measurements) &&
      baseline > kMinRefreshBaseline;
  return parallax || refresh || located_anew_;
}

std::optional<KeyframeRequest> KeyframeChooser::consider(
    const MapView& map, const Anchor& anchor, const std::shared_ptr<const Pyramid>& frame,
    const Localisation& found, const MotionModel& motion) {
  if (++frames_since_keyframe_ < kMinKeyframeGap || !is_wanted(map, anchor, found)) {
    return std::nullopt;
  }
  frames_since_keyframe_ = 0;
  located_anew_ = false;
  KeyframeRequest request{anchor.keyframe,
                          anchor.keyframe_from_camera,
                          found.pose.readout_twist,
                          frame,
                          {},
                          std::exchange(evidence_, {})};
  reserve_evidence();
  for (const Measurement& m : found.measurements) {
    if (m.inlier) {
      request.sightings.emplace_back(map.points[m.point].id, Sighting{-1, m.pixel, m.level});
    }
  }
  if (camera_.profile().readout_s == 0.0 || !motion.velocity()) return request;
  pending_.emplace(Pending{std::move(request), found, *motion.velocity(), motion.interval_s()});
  return std::nullopt;
}

std::optional<KeyframeRequest> KeyframeChooser::complete(const MotionModel& motion) {
  if (!pending_) return std::nullopt;
  Pending p = *std::exchange(pending_, std::nullopt);
  if (!motion.velocity()) return std::nullopt;
  const geometry::Vector6d velocity =
      (p.interval_s * p.velocity + motion.interval_s() * *motion.velocity()) /
      (p.interval_s + motion.interval_s());
  p.found.pose.readout_twist = camera_.profile().readout_s * velocity;
  const PoseEstimate estimate =
      estimate_pose(camera_, p.found.measurements, p.found.pose, options_.pose_iterations);
  p.request.reference_from_camera = p.request.reference_from_camera *
                                    p.found.pose.camera_from_world *
                                    estimate.pose.camera_from_world.inverse();
  p.request.readout_twist = estimate.pose.readout_twist;
  return std::move(p.request);
}

}  // namespace lumibox::tracking
