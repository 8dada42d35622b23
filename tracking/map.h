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

    const Sighting* sighting_in(KeyframeId keyframe) const;  ///< null: not seen there
  };
  struct Keyframe {
    geometry::Pose world_from_camera;                               ///< of the middle row
    geometry::Vector6d readout_twist = geometry::Vector6d::Zero();  ///< see geometry::FramePose
    std::shared_ptr<const Pyramid> pyramid;
    std::vector<PointId> points;  ///< that it sees, ascending
    double median_depth = 1.0;
    double scale = 1.0;  ///< see MapView::Keyframe

    KeyframeId tied_to = -1;                   ///< of a culled keyframe: another, not culled
    geometry::Similarity tied_from_this = {};  ///< stays, wherever the other moves

    bool culled() const { return tied_to >= 0; }
    geometry::FramePose frame_pose() const { return {world_from_camera.inverse(), readout_twist}; }
  };

  Map() = default;

  /// The map that `view` is a copy of.
  explicit Map(const MapView& view);

  KeyframeId add_keyframe(const geometry::FramePose& pose, std::shared_ptr<const Pyramid> pyramid);
  PointId add_point(const Eigen::Vector3d& position);

  /// Says that a keyframe sees a point; nothing happens if it is said already.
  void add_sighting(PointId point, const Sighting& sighting);
  void remove_sighting(PointId point, KeyframeId keyframe);
  void remove_point(PointId point);

  /// One point for two that are the same: `kept` gets the sightings of `other` in keyframes that do
  /// not see it themselves, and `other` is removed.
  void merge_points(PointId kept, PointId other);

  /// Takes a keyframe and its sightings out of the map, and points that are left with fewer than
  /// two. From now on it moves with `tie`, another that is not culled; so do those that were tied
  /// to it.
  void cull_keyframe(KeyframeId id, KeyframeId tie);

  /// Moves a keyframe to where `corrected` says and lengths around it with it.
  void move_keyframe(KeyframeId id, const geometry::Similarity& world_from_keyframe);

  bool has_point(PointId id) const { return points_.contains(id); }
  Point& point(PointId id) { return points_.at(id); }
  const Point& point(PointId id) const { return points_.at(id); }
  const std::map<PointId, Point>& points() const { return points_; }

  std::vector<Keyframe>& keyframes() { return keyframes_; }
  const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  Keyframe& keyframe(KeyframeId id) { return keyframes_[static_cast<std::size_t>(id)]; }
  const Keyframe& keyframe(KeyframeId id) const { return keyframes_[static_cast<std::size_t>(id)]; }

  /// Where a keyframe is, culled ones included; see MapView::Keyframe.
  geometry::Similarity world_from_keyframe(KeyframeId id) const;

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

}  // namespace lumibox::tracking
