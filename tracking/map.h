#pragma once

#include <map>
#include <memory>
#include <vector>

#include "geometry/pose.h"
#include "geometry/rolling_shutter.h"
#include "tracking/map_view.h"

namespace lumibox::tracking {

/// The map itself: keyframes and points and who sees whom. Owned and changed by the mapper alone;
/// everybody else works on published MapViews. Points refer to keyframes by id and back, never by
/// pointer, so removing one cannot leave anything dangling.
class Map {
 public:
  struct Point {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::vector<Sighting> sightings;
    int searched = 0;  ///< frames in which the tracker expected it
    int found = 0;     ///< frames in which it was found
  };
  struct Keyframe {
    geometry::Pose world_from_camera;                               ///< of the middle row
    geometry::Vector6d readout_twist = geometry::Vector6d::Zero();  ///< see geometry::FramePose
    std::shared_ptr<const Pyramid> pyramid;
    std::vector<PointId> points;  ///< that it sees, ascending
    double median_depth = 1.0;

    geometry::FramePose frame_pose() const { return {world_from_camera.inverse(), readout_twist}; }
  };

  KeyframeId add_keyframe(const geometry::FramePose& pose, std::shared_ptr<const Pyramid> pyramid);
  PointId add_point(const Eigen::Vector3d& position);

  /// Says that a keyframe sees a point; nothing happens if it is said already.
  void add_sighting(PointId point, const Sighting& sighting);
  void remove_sighting(PointId point, KeyframeId keyframe);
  void remove_point(PointId point);

  bool has_point(PointId id) const { return points_.contains(id); }
  Point& point(PointId id) { return points_.at(id); }
  const Point& point(PointId id) const { return points_.at(id); }
  const std::map<PointId, Point>& points() const { return points_; }

  std::vector<Keyframe>& keyframes() { return keyframes_; }
  const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  Keyframe& keyframe(KeyframeId id) { return keyframes_[static_cast<std::size_t>(id)]; }
  const Keyframe& keyframe(KeyframeId id) const { return keyframes_[static_cast<std::size_t>(id)]; }

  /// Brings median_depth of every keyframe up to date.
  void update_depths();

  /// Multiplies all lengths of the world.
  void scale(double factor);

  /// Copy of the map for those who only read.
  MapView view(std::uint64_t revision) const;

  /// The same with some of the points only.
  MapView view_of(const std::vector<PointId>& points) const;

 private:
  MapView view_without_points() const;

  std::vector<Keyframe> keyframes_;
  std::map<PointId, Point> points_;
  PointId next_point_ = 0;
};

/// Keyframes that share most points with `id`, most first, at most `count`; without `id` itself.
std::vector<KeyframeId> covisible_keyframes(const Map& map, KeyframeId id, int count);

}  // namespace lumibox::tracking
