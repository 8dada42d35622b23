#include "tracking/tracker.h"

#include <algorithm>
#include <limits>

#include "tracking/initialiser.h"
#include "tracking/judgement.h"
#include "tracking/keyframe_chooser.h"
#include "tracking/map_tracking.h"
#include "tracking/mapper.h"
#include "tracking/motion_model.h"
#include "tracking/pose_refinement.h"
#include "tracking/relocalisation.h"
#include "tracking/relocaliser.h"
#include "tracking/turn_follower.h"

namespace lumibox::tracking {
namespace {

constexpr double kMinContrast = 6.0;  // grey levels; a dark or covered lens shows less
constexpr int kTurnTries = 15;        // frames from one try to relocalise to the next
constexpr int kRestFrames = 30;       // without a keyframe, until the mapper does what can wait

}  // namespace

class Tracker::Impl {
 public:
  Impl(const geometry::Camera& camera, const config::Tracking& options, Mapping mapping,
       std::uint32_t seed)
      : camera_(camera),
        options_(options),
        initialiser_(camera, options, seed),
        mapper_(camera, options, mapping),
        relocaliser_(camera, options, seed),
        motion_(camera),
        turn_(camera, options),
        chooser_(camera, options),
        localiser_(camera, options) {}

  void resume(const MapView& saved) {
    mapper_.resume(saved);
    map_ = mapper_.view();
    anchor_ = static_cast<KeyframeId>(map_->keyframes.size()) - 1;
    while (anchor_ > 0 && keyframe(anchor_).culled()) --anchor_;
    camera_from_world_ = keyframe(anchor_).camera_from_world;
    lost_ = true;
  }

  TrackedFrame track(const hal::Image& gray, std::int64_t index, std::int64_t timestamp_ns) {
    TrackedFrame result;
    result.index = index;
    result.timestamp_ns = timestamp_ns;
    const auto frame = pyramids_.make(gray, options_.pyramid_levels);
    motion_.next_frame(*frame, timestamp_ns);
    visible_.clear();
    measured_.points.clear();
    if (!map_) {
      initialise(frame, result);
    } else {
      adopt_newest_map();
      jumped_ = false;
      const Localisation* found = lost_ ? relocalise(*frame) : localise_from_motion(*frame);
      judge(found, frame, result);
      extend_map(frame, found);
    }
    return result;
  }

  /// What the frame asks of the mapper; in lockstep it is done when this returns.
  void hand_to_mapper() {
    if (wanted_) mapper_.request(*std::exchange(wanted_, std::nullopt));
    if (frames_at_rest_ == kRestFrames) mapper_.rest();
  }

  std::optional<geometry::Similarity> world_from_keyframe(KeyframeId id) const {
    const auto map = mapper_.view();
    if (!map || id < 0 || static_cast<std::size_t>(id) >= map->keyframes.size())
      return std::nullopt;
    return map->keyframes[static_cast<std::size_t>(id)].world_from_keyframe();
  }

  std::uint64_t map_revision() const {
    const auto map = mapper_.view();
    return map ? map->revision : 0;
  }

  std::shared_ptr<const MapView> map() const { return mapper_.view(); }

  std::vector<MapPoint> points() const {
    std::vector<MapPoint> points;
    if (const auto map = mapper_.view()) {
      for (const MapView::Point& p : map->points) {
        if (p.sightings >= 3) points.push_back({p.position, static_cast<int>(p.sightings)});
      }
    }
    return points;
  }

  const std::vector<Eigen::Vector3d>& visible_points() const { return visible_; }

  const FrameMeasurements& measurements() const { return measured_; }

  TrackerStatistics statistics() const {
    TrackerStatistics s;
    if (const auto map = mapper_.view()) {
      s.keyframes =
          static_cast<int>(std::count_if(map->keyframes.begin(), map->keyframes.end(),
                                         [](const MapView::Keyframe& k) { return !k.culled(); }));
      s.loops_closed = map->loops_closed;
      s.points = static_cast<int>(map->points.size());
    }
    s.relocalisations = relocalisations_;
    return s;
  }

  bool mapping() const { return mapper_.busy(); }

  void finish() {
    mapper_.finish();
    if (map_) adopt_newest_map();
  }

  std::optional<std::string> mapping_error() const { return mapper_.error(); }

 private:
  const MapView::Keyframe& keyframe(KeyframeId id) const {
    return map_->keyframes[static_cast<std::size_t>(id)];
  }

  void initialise(const std::shared_ptr<const Pyramid>& frame, TrackedFrame& result) {
    const Initialiser::Progress progress = initialiser_.add(frame, result.timestamp_ns);
    result.state = TrackingState::Initialising;
    result.reason = progress.reason;
    if (!progress.map) return;
    mapper_.start(*progress.map);
    map_ = mapper_.view();
    anchor_ = 1;
    last_pose_ns_ = motion_.timestamp_ns();
    anchor_from_camera_ = geometry::Pose();
    camera_from_world_ = keyframe(1).camera_from_world;
    for (const MapView::Point& p : map_->points) visible_.push_back(p.position);
    report_pose(TrackingState::Good, static_cast<int>(map_->points.size()), result);
  }

  /// Moves the last pose along with the keyframe that it hangs on.
  void adopt_newest_map() {
    auto newest = mapper_.view();
    if (newest->revision == map_->revision) return;
    map_ = std::move(newest);
    camera_from_world_ = (keyframe(anchor_).world_from_keyframe() * anchor_from_camera_).inverse();
  }

  const Localisation* localise_from_motion(const Pyramid& frame) {
    predicted_ = motion_.predict(camera_from_world_);
    const Localisation* found = localiser_.localise(*map_, frame, predicted_);
    if (found && camera_.profile().readout_s > 0.0) {
      found = localiser_.with_readout(
          motion_.readout_twist(camera_from_world_, found->pose.camera_from_world));
    }
    // While the camera is turned away the map may show by chance, or from elsewhere.
    if (turn_.active() && !(found && trust_in(*found, options_) >= Trust::Place)) {
      return ++frames_turned_ % kTurnTries == 0 ? relocalise(frame) : nullptr;
    }
    return found;
  }

  const Localisation* relocalise(const Pyramid& frame) {
    std::vector<PossiblePlace> places;
    const double depth = keyframe(anchor_).median_depth;
    for (const geometry::Pose& pose : relocaliser_.find(*map_, frame, motion_.picture())) {
      const bool known = std::ranges::any_of(places, [&](const PossiblePlace& place) {
        return is_same_place(place.camera_from_world, pose, depth);
      });
      if (known) continue;
      const Localisation* here = localiser_.localise(*map_, frame, pose);
      if (!here || !is_verified(*here)) continue;
      places.push_back({here->pose.camera_from_world, here->inliers});
    }
    const double seconds = last_pose_ns_
                               ? 1e-9 * static_cast<double>(motion_.timestamp_ns() - *last_pose_ns_)
                               : std::numeric_limits<double>::infinity();
    const auto chosen = choose_place(places, {camera_from_world_, depth, seconds});
    if (!chosen) return nullptr;
    const Localisation* found =
        localiser_.localise(*map_, frame, places[*chosen].camera_from_world);
    if (!found) return nullptr;
    lost_ = false;
    jumped_ = true;
    ++relocalisations_;
    chooser_.located_anew();
    return found;
  }

  /// What is trusted little is not trusted at all where no hand can be.
  Trust trusted(const Localisation& found) const {
    const Trust trust = trust_in(found, options_);
    if (trust != Trust::Little || jumped_) return trust;
    const geometry::Pose found_from_expected =
        found.pose.camera_from_world * motion_.expect(camera_from_world_).inverse();
    return is_within_reach(found_from_expected, found.median_depth) ? trust : Trust::None;
  }

  /// Decides from what was found how far the pose can be trusted, and remembers it.
  void judge(const Localisation* found, const std::shared_ptr<const Pyramid>& frame,
             TrackedFrame& result) {
    result.reason = motion_.picture().contrast() < kMinContrast ? TrackingReason::TooDarkOrBlurred
                    : lost_                                     ? TrackingReason::Relocalising
                                                                : TrackingReason::TooFewPointsFound;
    const Trust trust = found ? trusted(*found) : Trust::None;
    const bool shown = trust >= Trust::Place;
    if (!shown && follow_turn(frame, result)) return;
    if (shown) {
      turn_.stop();
    } else if (!lost_) {
      relocaliser_.prepare(*map_, motion_.picture());
    }
    bad_frames_ = shown ? 0 : bad_frames_ + 1;
    if (bad_frames_ >= options_.lost_after_frames) lost_ = true;
    if (lost_ || trust == Trust::None) {
      result.state = lost_ ? TrackingState::Lost : TrackingState::Poor;
      motion_.interrupted();
      last_shown_.reset();
      return;
    }
    if (jumped_) {
      motion_.interrupted();
    } else {
      motion_.moved(camera_from_world_, found->pose.camera_from_world);
    }
    camera_from_world_ = found->pose.camera_from_world;
    choose_anchor();
    show(*found);
    chooser_.note(*map_, *found);
    last_shown_ = shown ? frame : nullptr;
    if (shown) last_pose_ns_ = motion_.timestamp_ns();
    report_pose(trust == Trust::Full ? TrackingState::Good : TrackingState::Poor, found->inliers,
                result);
  }

  /// Decides on a keyframe where the map needs one. A pose that is not certain enough to record
  /// with may well be one from which the map grows until it is.
  void extend_map(const std::shared_ptr<const Pyramid>& frame, const Localisation* found) {
    const bool shown = found && last_shown_ == frame;
    const auto ask = [&](std::optional<KeyframeRequest> request) {
      if (!request || !shown) return;
      wanted_ = std::move(request);
      frames_at_rest_ = 0;
    };
    ask(chooser_.complete(motion_));
    if (shown && !mapper_.busy()) {
      ask(chooser_.consider(*map_, {anchor_, anchor_from_camera_}, frame, *found, motion_));
    }
    ++frames_at_rest_;
  }

  /// Where the map no longer shows, a turn on the spot may explain the picture: the pose then is
  /// held, turned, and not good enough to record with. False if it does not.
  bool follow_turn(const std::shared_ptr<const Pyramid>& frame, TrackedFrame& result) {
    if (!turn_.active()) {
      if (!last_shown_) return false;
      frames_turned_ = 0;
      turn_.start(last_shown_, camera_from_world_.rotation);
    }
    std::optional<Eigen::Quaterniond> turned;
    if (!lost_) turned = turn_.follow(frame, predicted_.camera_from_world.rotation);
    if (!turned) turned = turn_.find(frame, motion_.picture());
    if (!turned) return false;
    lost_ = false;
    const Eigen::Vector3d center = camera_from_world_.inverse().translation;
    const geometry::Pose held(*turned, -(*turned * center));
    motion_.moved(camera_from_world_, held);
    camera_from_world_ = held;
    hang_on(anchor_);
    bad_frames_ = 0;
    report_pose(TrackingState::Poor, 0, result);
    result.reason = TrackingReason::TurningOnly;
    return true;
  }

  void report_pose(TrackingState state, int measurements, TrackedFrame& result) const {
    result.state = state;
    result.world_from_camera = camera_from_world_.inverse();
    result.keyframe = anchor_;
    result.keyframe_from_camera = anchor_from_camera_;
    result.measurements = measurements;
    if (state == TrackingState::Good) result.reason = TrackingReason::None;
  }

  /// The keyframe nearest in place, among those that look the same way.
  void choose_anchor() {
    const geometry::Pose world_from_camera = camera_from_world_.inverse();
    const Eigen::Vector3d forward = world_from_camera.rotation * Eigen::Vector3d::UnitZ();
    KeyframeId nearest = anchor_;
    double best = std::numeric_limits<double>::infinity();
    for (KeyframeId id = 0; id < static_cast<KeyframeId>(map_->keyframes.size()); ++id) {
      if (keyframe(id).culled()) continue;
      const geometry::Pose& pose = keyframe(id).world_from_camera;
      const double facing = forward.dot(pose.rotation * Eigen::Vector3d::UnitZ());
      const double distance = (pose.translation - world_from_camera.translation).norm();
      if (facing > 0.5 && distance < best) {
        best = distance;
        nearest = id;
      }
    }
    hang_on(nearest);
  }

  void hang_on(KeyframeId id) {
    anchor_ = id;
    anchor_from_camera_ =
        keyframe(id).world_from_keyframe().inverse() * camera_from_world_.inverse();
  }

  void show(const Localisation& found) {
    for (const Measurement& m : found.measurements) {
      if (!m.inlier) continue;
      visible_.push_back(m.position);
      measured_.points.push_back({map_->points[m.point].id, m.pixel.cast<float>(), m.level});
    }
    measured_.readout_twist = found.pose.readout_twist;
  }

  const geometry::Camera camera_;
  const config::Tracking options_;
  Initialiser initialiser_;
  Mapper mapper_;
  PyramidPool pyramids_;
  Relocaliser relocaliser_;
  MotionModel motion_;
  TurnFollower turn_;
  KeyframeChooser chooser_;
  Localiser localiser_;

  std::shared_ptr<const MapView> map_;         // the copy in use; null before initialisation
  geometry::Pose camera_from_world_;           // of the last frame with a pose
  geometry::FramePose predicted_;              // of the present frame
  std::shared_ptr<const Pyramid> last_shown_;  // the last frame, if it showed the map
  int frames_at_rest_ = 0;                     // since the last keyframe
  std::optional<KeyframeRequest> wanted_;      // of the present frame, until the mapper has it
  int frames_turned_ = 0;                      // since the map last showed
  KeyframeId anchor_ = -1;
  geometry::Pose anchor_from_camera_;
  bool lost_ = false;
  bool jumped_ = false;  // this frame was located anew
  int bad_frames_ = 0;
  std::optional<std::int64_t> last_pose_ns_;  // of the last good one; none since a resume
  int relocalisations_ = 0;
  std::vector<Eigen::Vector3d> visible_;
  FrameMeasurements measured_;
};

Tracker::Tracker(const geometry::Camera& camera, const config::Tracking& options, Mapping mapping,
                 std::uint32_t seed, std::shared_ptr<const MapView> saved)
    : begin_([=] { return std::make_unique<Impl>(camera, options, mapping, seed); }),
      impl_(begin_()) {
  if (saved) impl_->resume(*saved);
}
Tracker::~Tracker() = default;

void Tracker::start_over() {
  impl_.reset();  // first, for its thread must not run beside another
  impl_ = begin_();
}

TrackedFrame Tracker::track(const hal::Image& gray, std::int64_t index, std::int64_t timestamp_ns,
                            const std::function<void()>& before_mapping) {
  TrackedFrame result = impl_->track(gray, index, timestamp_ns);
  if (before_mapping) before_mapping();
  impl_->hand_to_mapper();
  return result;
}
std::optional<geometry::Similarity> Tracker::world_from_keyframe(KeyframeId id) const {
  return impl_->world_from_keyframe(id);
}
std::uint64_t Tracker::map_revision() const {
  return impl_->map_revision();
}
std::shared_ptr<const MapView> Tracker::map() const {
  return impl_->map();
}
std::vector<MapPoint> Tracker::points() const {
  return impl_->points();
}
std::vector<Eigen::Vector3d> Tracker::visible_points() const {
  return impl_->visible_points();
}
const FrameMeasurements& Tracker::measurements() const {
  return impl_->measurements();
}
TrackerStatistics Tracker::statistics() const {
  return impl_->statistics();
}
bool Tracker::mapping() const {
  return impl_->mapping();
}
void Tracker::finish() {
  impl_->finish();
}
std::optional<std::string> Tracker::mapping_error() const {
  return impl_->mapping_error();
}

}  // namespace lumibox::tracking
