#include "tracking/initialiser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/video/tracking.hpp>

#include "geometry/robust.h"
#include "geometry/triangulation.h"
#include "geometry/two_view.h"
#include "tracking/corners.h"
#include "tracking/opencv_view.h"
#include "tracking/patch.h"
#include "tracking/rolling_start.h"
#include "tracking/third_view.h"

namespace lumibox::tracking {
namespace {

constexpr std::size_t kMinCorners = 100;  // fewer do not cover a picture
constexpr double kMinTrackShare = 0.4;    // of the first frame's corners; below, start again
constexpr double kMinFlowShare = 0.008;   // of the picture's width: less is a still camera
constexpr double kNoisePx = 0.7;          // of a followed corner, standard deviation

}  // namespace

struct Initialiser::Track {
  Eigen::Vector2d first;               // level 0
  Eigen::Vector2d current;             // level 0
  int level = 0;                       // its corner was found on
  std::optional<PatchTemplate> patch;  // of the first frame, on that level
  std::vector<Eigen::Vector2d> path;   // in every frame since the first, level 0
};

Initialiser::Initialiser(const geometry::Camera& camera, const config::Tracking& options,
                         std::uint32_t seed)
    : camera_(camera), options_(options), seed_(seed) {}
Initialiser::~Initialiser() = default;

void Initialiser::restart(const std::shared_ptr<const Pyramid>& frame, std::int64_t timestamp_ns) {
  times_ns_ = {timestamp_ns};
  first_ = frame;
  last_ = frame;
  tracks_.clear();
  for (const Corner& corner :
       detect_corners(*frame, options_.fast_threshold, options_.max_features_per_keyframe)) {
    const Eigen::Vector2d pixel = from_level(corner.pixel, corner.level);
    tracks_.push_back(
        {pixel,
         pixel,
         corner.level,
         make_template(frame->level(corner.level), corner.pixel, Eigen::Matrix2d::Identity()),
         {}});
  }
  tracks_at_start_ = tracks_.size();
}

void Initialiser::follow(const std::shared_ptr<const Pyramid>& frame) {
  std::vector<cv::Point2f> before;
  for (const Track& t : tracks_) {
    before.emplace_back(static_cast<float>(t.current.x()), static_cast<float>(t.current.y()));
  }
  std::vector<cv::Point2f> after;
  std::vector<cv::Point2f> back;
  std::vector<std::uint8_t> found;
  std::vector<std::uint8_t> found_back;
  std::vector<float> error;
  const cv::Mat last = opencv_view(last_->level(0));
  const cv::Mat current = opencv_view(frame->level(0));
  const cv::Size window(15, 15);
  cv::calcOpticalFlowPyrLK(last, current, before, after, found, error, window, 4);
  cv::calcOpticalFlowPyrLK(current, last, after, back, found_back, error, window, 4);

  std::vector<Track> kept;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const cv::Point2f round_trip = back[i] - before[i];
    if (found[i] == 0 || found_back[i] == 0 || round_trip.dot(round_trip) > 1.0F) continue;
    Track t = std::move(tracks_[i]);
    t.path.push_back(t.current);
    t.current = Eigen::Vector2d(static_cast<double>(after[i].x), static_cast<double>(after[i].y));
    refine(*frame, t);
    if (camera_.contains(t.current, 4.0)) kept.push_back(std::move(t));
  }
  tracks_ = std::move(kept);
  last_ = frame;
}

/// Sharpens a place found from frame to frame by comparison with the first frame: errors do not add
/// up, and an exposure that changes does no harm.
void Initialiser::refine(const Pyramid& frame, Track& track) {
  constexpr double kFarthest = 1.0;  // pixels of the level: beyond, the two disagree
  if (!track.patch) return;
  const Eigen::Vector2d start = to_level(track.current, track.level);
  const auto aligned = align_patch(frame.level(track.level), *track.patch, start);
  if (aligned && (*aligned - start).norm() < kFarthest) {
    track.current = from_level(*aligned, track.level);
  }
}

double Initialiser::median_flow_px() const {
  std::vector<double> flow;
  for (const Track& t : tracks_) flow.push_back((t.current - t.first).norm());
  return geometry::median(std::move(flow));
}

Initialiser::Progress Initialiser::add(const std::shared_ptr<const Pyramid>& frame,
                                       std::int64_t timestamp_ns) {
  if (!first_) {
    restart(frame, timestamp_ns);
    return {std::nullopt, tracks_.size() < kMinCorners ? TrackingReason::TooLittleTexture
                                                       : TrackingReason::MoveSideways};
  }
  times_ns_.push_back(timestamp_ns);
  if (!tracks_.empty()) follow(frame);
  const double share = static_cast<double>(tracks_.size()) /
                       static_cast<double>(std::max<std::size_t>(tracks_at_start_, 1));
  if (tracks_.size() < kMinCorners || share < kMinTrackShare) {
    restart(frame, timestamp_ns);
    return {std::nullopt, tracks_.size() < kMinCorners ? TrackingReason::TooLittleTexture
                                                       : TrackingReason::MoveSideways};
  }
  if (median_flow_px() < kMinFlowShare * camera_.width()) {
    return {std::nullopt, TrackingReason::MoveSideways};
  }
  return solve(frame);
}

Initialiser::Progress Initialiser::solve(const std::shared_ptr<const Pyramid>& frame) {
  std::vector<geometry::BearingPair> pairs;
  std::vector<const Track*> used;
  for (const Track& t : tracks_) {
    const auto first = camera_.unproject(t.first);
    const auto second = camera_.unproject(t.current);
    if (!first || !second) continue;
    pairs.push_back({first->homogeneous().normalized(), second->homogeneous().normalized()});
    used.push_back(&t);
  }
  geometry::TwoViewOptions options;
  options.sigma_rad = kNoisePx / camera_.profile().fx;
  options.min_inliers = options_.init_min_inliers;
  options.min_parallax_rad = options_.init_min_parallax_deg * std::numbers::pi / 180.0;
  options.seed = seed_;
  const geometry::TwoViewResult motion = geometry::solve_two_view(pairs, options);
  switch (motion.outcome) {
    case geometry::TwoViewOutcome::Ok:
      return make_map(frame, motion.second_from_first, motion.inliers, pairs, used);
    case geometry::TwoViewOutcome::TooFewPoints:
      return {std::nullopt, TrackingReason::TooLittleTexture};
    case geometry::TwoViewOutcome::RotationOnly:
      return {std::nullopt, TrackingReason::TurningOnly};
    case geometry::TwoViewOutcome::PlaneAmbiguous:
      if (const auto decided = decide(motion, pairs, used)) {
        return make_map(frame, *decided, motion.inliers, pairs, used);
      }
      return {std::nullopt, TrackingReason::PlaneAmbiguous};
    case geometry::TwoViewOutcome::NotEnoughInliers:
    case geometry::TwoViewOutcome::NoMotion:
    case geometry::TwoViewOutcome::LowParallax:
      return {std::nullopt, TrackingReason::MoveSideways};
  }
  return {std::nullopt, TrackingReason::MoveSideways};
}

std::optional<geometry::Pose> Initialiser::decide(const geometry::TwoViewResult& motion,
                                                  std::span<const geometry::BearingPair> pairs,
                                                  std::span<const Track* const> used) const {
  // Three views in between, evenly: the nearer to the middle, the more the shapes differ there.
  constexpr std::size_t kBetween = 3;
  ManyViews views;
  views.between.resize(kBetween);
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto& path = used[i]->path;
    if (!motion.inliers[i] || path.size() < 2 * kBetween) continue;
    std::array<Eigen::Vector3d, kBetween> bearings;
    bool seen = true;
    for (std::size_t v = 0; v < kBetween && seen; ++v) {
      const auto ray = camera_.unproject(path[(v + 1) * path.size() / (kBetween + 1)]);
      seen = ray.has_value();
      if (seen) bearings[v] = ray->homogeneous().normalized();
    }
    if (!seen) continue;
    views.first.push_back(pairs[i].first);
    views.second.push_back(pairs[i].second);
    for (std::size_t v = 0; v < kBetween; ++v) views.between[v].push_back(bearings[v]);
  }
  const auto chosen =
      decide_by_third_view(motion.candidates, views, 2.0 * kNoisePx / camera_.profile().fx);
  if (!chosen) return std::nullopt;
  return motion.candidates[*chosen];
}

Initialiser::Progress Initialiser::make_map(const std::shared_ptr<const Pyramid>& frame,
                                            const geometry::Pose& second_from_first,
                                            const std::vector<bool>& inliers,
                                            std::span<const geometry::BearingPair> pairs,
                                            std::span<const Track* const> used) const {
  InitialMap map;
  map.first = first_;
  map.second = frame;
  map.second_from_first = second_from_first;
  std::vector<PointPath> paths;
  std::vector<double> depths;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!inliers[i]) continue;
    const auto point =
        geometry::triangulate(geometry::Pose(), second_from_first, pairs[i].first, pairs[i].second);
    if (!point) continue;
    map.points.push_back({*point, used[i]->first, used[i]->current, used[i]->level});
    paths.push_back(used[i]->path);
    paths.back().push_back(used[i]->current);
    depths.push_back(point->z());
  }
  if (map.points.size() < static_cast<std::size_t>(options_.init_min_inliers)) {
    return {std::nullopt, TrackingReason::MoveSideways};
  }
  const double scale = 1.0 / geometry::median(std::move(depths));
  map.second_from_first.translation *= scale;
  for (InitialMap::Point& p : map.points) p.position *= scale;
  if (camera_.profile().readout_s > 0.0) correct_for_readout(camera_, times_ns_, paths, map);
  return {std::move(map), TrackingReason::None};
}

}  // namespace lumibox::tracking
