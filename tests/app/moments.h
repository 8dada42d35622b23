#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "app/moment.h"
#include "hal/image.h"
#include "support/pinhole.h"

namespace lumibox::testing {

/// A world without a tracker: keyframes are where a test puts them, and each moment is what the box
/// sees from a pose.
class World {
 public:
  /// Keyframe 0 stands at the origin.
  World() { keyframes_[0] = geometry::Pose{}; }

  void move_keyframe(tracking::KeyframeId id, const geometry::Pose& world_from_keyframe) {
    keyframes_[id] = world_from_keyframe;
    ++revision_;
  }

  app::MapNow map() const {
    return {revision_,
            [this](tracking::KeyframeId id) -> std::optional<geometry::Similarity> {
              const auto it = keyframes_.find(id);
              if (it == keyframes_.end()) return std::nullopt;
              return geometry::Similarity{1.0, it->second};
            },
            [] {
              return std::vector<Eigen::Vector3d>{{1.0, 2.0, 3.0}};
            },
            [this] { return copy(); }};
  }

  /// What a tracker would keep: keyframes from 0 on, those that no test put elsewhere at the
  /// origin, and a point that the first sees.
  std::shared_ptr<const tracking::MapView> copy() const {
    auto map = std::make_shared<tracking::MapView>();
    for (tracking::KeyframeId id = 0; id <= keyframes_.rbegin()->first; ++id) {
      const auto it = keyframes_.find(id);
      tracking::MapView::Keyframe keyframe;
      keyframe.world_from_camera = it == keyframes_.end() ? geometry::Pose{} : it->second;
      keyframe.camera_from_world = keyframe.world_from_camera.inverse();
      keyframe.pyramid = std::make_shared<tracking::Pyramid>(hal::Image(64, 48, 1), 2);
      map->keyframes.push_back(keyframe);
    }
    map->points.push_back({.id = 0, .position = Eigen::Vector3d::UnitZ(), .sightings = 1});
    map->sightings.push_back({0, {32.0, 24.0}, 0});
    map->next_point = 1;
    return map;
  }

  /// Well tracked, hanging on keyframe 0, with a wall of points one unit ahead.
  app::Moment see_from(const geometry::Pose& world_from_camera) {
    app::Moment moment;
    moment.frame.index = frames_;
    moment.frame.timestamp_ns = frames_ * 33'000'000;
    moment.frame.color = std::make_shared<hal::Image>(64, 48, 3);
    moment.frame.gray = std::make_shared<hal::Image>(64, 48, 1);
    moment.now_ns = moment.frame.timestamp_ns;
    moment.fresh = true;
    moment.tracked.index = moment.frame.index;
    moment.tracked.timestamp_ns = moment.frame.timestamp_ns;
    moment.tracked.state = tracking::TrackingState::Good;
    moment.tracked.world_from_camera = world_from_camera;
    moment.tracked.keyframe = 0;
    moment.tracked.keyframe_from_camera = keyframes_[0].inverse() * world_from_camera;
    for (int i = 0; i < 25; ++i) {
      moment.map_points.push_back(world_from_camera *
                                  Eigen::Vector3d(0.02 * (i % 5 - 2), 0.02 * (i / 5 - 2), 1.0));
    }
    moment.map = map();
    ++frames_;
    return moment;
  }

  /// A frame that the tracker has lost.
  app::Moment see_nothing(tracking::TrackingReason reason) {
    app::Moment moment = see_from({});
    moment.tracked.state = tracking::TrackingState::Lost;
    moment.tracked.reason = reason;
    moment.tracked.world_from_camera.reset();
    moment.tracked.keyframe = -1;
    moment.map_points.clear();
    return moment;
  }

 private:
  std::map<tracking::KeyframeId, geometry::Pose> keyframes_;
  std::uint64_t revision_ = 0;
  std::int64_t frames_ = 0;
};

/// The camera of World's pictures.
inline geometry::Camera small_camera() {
  return pinhole(64, 48, 60.0);
}

/// A camera on the unit circle around (0, 0, 1), that looks at it; angle 0 is the origin.
inline geometry::Pose around_subject(double angle) {
  const Eigen::Quaterniond turn = geometry::exp_so3({0.0, angle, 0.0});
  return {turn, Eigen::Vector3d::UnitZ() - turn * Eigen::Vector3d::UnitZ()};
}

}  // namespace lumibox::testing
