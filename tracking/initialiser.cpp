#include "tracking/initialiser.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geometry/robust.h"
#include "tracking/corner_tracks.h"
#include "tracking/first_structure.h"
#include "tracking/rolling_start.h"

namespace lumibox::tracking {
namespace {

constexpr std::size_t kMinCorners = 100;  // fewer do not cover a picture
constexpr double kMinTrackShare = 0.4;    // of the reference's corners; below, they are given up
constexpr double kLaterShare = 0.7;       // below, a later reference is followed as well
constexpr double kMinFlowShare = 0.008;   // of the picture's width: less is a still camera
constexpr double kNoisePx = 0.7;          // of a followed corner, generous: tells outliers
constexpr double kGrowth = 0.1;           // of the flow, that makes another attempt worth its time
constexpr int kPatience = 5;              // frames after which another is made in any case
constexpr std::size_t kViews = 7;         // adjusted together
constexpr int kTornFrames = 2;            // corners that are gone by then were none
constexpr double kDark = 32.0;            // grey levels; an eighth of what a bright spot has
constexpr double kBlurredContrast = 2.0;  // grey levels from one coarse pixel to the next

/// A picture without corners is dark, or blurred if what it shows is coarse, or shows nothing.
TrackingReason why_without_corners(const Pyramid& picture) {
  const hal::Image& coarse = picture.level(picture.levels() - 1);
  std::vector<double> values;
  double squares = 0.0;
  for (int v = 1; v < coarse.height(); ++v) {
    for (int u = 1; u < coarse.width(); ++u) {
      const double here = *coarse.at(u, v);
      values.push_back(here);
      squares += 0.5 * (std::pow(here - *coarse.at(u - 1, v), 2) +
                        std::pow(here - *coarse.at(u, v - 1), 2));
    }
  }
  const double contrast =
      std::sqrt(squares / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
  const bool dark = geometry::quantile(std::move(values), 0.95) < kDark;
  return dark || contrast > kBlurredContrast ? TrackingReason::TooDarkOrBlurred
                                             : TrackingReason::TooLittleTexture;
}

/// The first view, and of those after the camera stood still evenly in time up to the last; the one
/// nearest to `timestamp_ns` too.
std::vector<std::size_t> choose_views(const CornerTracks& tracks,
                                      std::optional<std::int64_t> timestamp_ns) {
  const std::vector<std::int64_t>& times_ns = tracks.times_ns();
  const auto index_of = [&](auto found) {
    return std::min(static_cast<std::size_t>(found - times_ns.begin()), times_ns.size() - 1);
  };
  const std::size_t moving = index_of(std::ranges::upper_bound(times_ns, tracks.still_until_ns()));
  const std::size_t span = times_ns.size() - 1 - moving;
  const std::size_t count = std::min(kViews - 1, span + 1);
  std::vector<std::size_t> views{0};
  for (std::size_t v = 1; v < count; ++v) views.push_back(moving + (v - 1) * span / (count - 1));
  views.push_back(times_ns.size() - 1);
  if (timestamp_ns && views.size() > 2) {
    const std::size_t wanted = std::clamp<std::size_t>(
        index_of(std::ranges::lower_bound(times_ns, *timestamp_ns)), 1, times_ns.size() - 2);
    auto nearest = std::ranges::min_element(
        views.begin() + 1, views.end() - 1, {},
        [&](std::size_t v) { return v > wanted ? v - wanted : wanted - v; });
    *nearest = wanted;
  }
  return views;
}

}  // namespace

Initialiser::Initialiser(const geometry::Camera& camera, const config::Tracking& options,
                         std::uint32_t seed)
    : camera_(camera), options_(options), seed_(seed) {}
Initialiser::~Initialiser() = default;

Initialiser::Progress Initialiser::add(const std::shared_ptr<const Pyramid>& frame,
                                       std::int64_t timestamp_ns) {
  const auto picture = std::make_shared<const FlowPicture>(frame);
  if (tracks_) tracks_->follow(picture, timestamp_ns, camera_);
  if (later_) later_->follow(picture, timestamp_ns, camera_);
  if (!holds(tracks_)) {
    const bool torn = tracks_ && tracks_->frames() <= kTornFrames;
    tracks_ = std::move(later_);
    claim_.reset();
    flow_at_attempt_px_ = 0.0;
    if (!holds(tracks_)) {
      begin(picture, timestamp_ns, torn);
      return {std::nullopt, reason_};
    }
  }
  if (!later_ && tracks_->share() < kLaterShare) {
    later_ = std::make_unique<CornerTracks>(picture, timestamp_ns, options_.fast_threshold);
  }
  if (tracks_->median_flow_px() < kMinFlowShare * camera_.width()) {
    reason_ = TrackingReason::MoveSideways;
  } else if (is_due()) {
    auto map = attempt(frame);
    if (map) return {std::move(map), TrackingReason::None};
  }
  return {std::nullopt, reason_};
}

bool Initialiser::holds(const std::unique_ptr<CornerTracks>& tracks) {
  return tracks && tracks->tracks().size() >= kMinCorners && tracks->share() >= kMinTrackShare;
}

/// Corners that are gone at once were blurred away, or were never more than noise in the dark.
void Initialiser::begin(const std::shared_ptr<const FlowPicture>& picture,
                        std::int64_t timestamp_ns, bool torn) {
  tracks_ = std::make_unique<CornerTracks>(picture, timestamp_ns, options_.fast_threshold);
  later_.reset();
  if (tracks_->tracks().size() < kMinCorners) {
    reason_ = why_without_corners(picture->pyramid());
  } else {
    reason_ = torn ? TrackingReason::TooDarkOrBlurred : TrackingReason::MoveSideways;
  }
}

bool Initialiser::is_due() {
  const double flow = tracks_->median_flow_px();
  ++frames_since_attempt_;
  const bool grown = std::abs(flow - flow_at_attempt_px_) > kGrowth * flow_at_attempt_px_;
  if (!grown && frames_since_attempt_ < kPatience) return false;
  flow_at_attempt_px_ = flow;
  frames_since_attempt_ = 0;
  return true;
}

std::optional<InitialMap> Initialiser::attempt(const std::shared_ptr<const Pyramid>& frame) {
  const std::vector<std::int64_t>& times_ns = tracks_->times_ns();
  const std::optional<std::int64_t> claimed =
      claim_ ? std::optional(claim_->timestamp_ns) : std::nullopt;
  const std::vector<std::size_t> views = choose_views(*tracks_, claimed);
  Bearings bearings(views.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (const CornerTracks::Track& track : tracks_->tracks()) {
      bearings[v].push_back(camera_.unproject(track.path[views[v]])->homogeneous().normalized());
    }
  }
  FirstStructureOptions options;
  options.noise_rad = kNoisePx / camera_.profile().fx;
  options.min_points = options_.init_min_inliers;
  options.max_depth_sigma = options_.init_max_depth_sigma;
  options.seed = seed_;
  const FirstStructure structure = find_first_structure(bearings, options);
  reason_ = structure.reason;
  if (structure.reason != TrackingReason::None) {
    claim_.reset();
    return std::nullopt;
  }
  reason_ = TrackingReason::MoveSideways;
  bool confirmed = false;
  if (claim_) {
    for (std::size_t v = 1; v < views.size(); ++v) {
      if (times_ns[views[v]] >= claim_->timestamp_ns) {
        confirmed = agrees(claim_->last_from_first, structure.view_from_first[v - 1]);
        break;
      }
    }
  }
  claim_ = Claim{times_ns.back(), structure.view_from_first.back()};
  if (!confirmed) return std::nullopt;
  return make_map(frame, structure);
}

std::optional<InitialMap> Initialiser::make_map(const std::shared_ptr<const Pyramid>& frame,
                                                const FirstStructure& structure) const {
  InitialMap map;
  map.first = tracks_->reference();
  map.second = frame;
  map.second_from_first = structure.view_from_first.back();
  std::vector<PointPath> paths;
  std::vector<double> depths;
  for (std::size_t i = 0; i < structure.points.size(); ++i) {
    if (!structure.points[i]) continue;
    const CornerTracks::Track& track = tracks_->tracks()[i];
    map.points.push_back(
        {*structure.points[i], track.path.front(), track.path.back(), track.level});
    paths.push_back(track.path);
    depths.push_back(structure.points[i]->z());
  }
  const double scale = 1.0 / geometry::median(std::move(depths));
  map.second_from_first.translation *= scale;
  for (InitialMap::Point& p : map.points) p.position *= scale;
  if (camera_.profile().readout_s > 0.0) {
    correct_for_readout(camera_, tracks_->times_ns(), paths, map);
  }
  return map;
}

}  // namespace lumibox::tracking
