#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/pose.h"
#include "tracking/pyramid.h"
#include "tracking/tracked_frame.h"

namespace lumibox::tracking {

using PointId = std::int32_t;  ///< never reused; -1 is none

/// Where a picture shows a map point.
struct Sighting {
  KeyframeId keyframe = -1;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< on level 0
  int level = 0;  ///< pyramid level it was measured on; its error is about half a pixel of that
};

/// An immutable copy of the map, as the mapper last published it. The tracker works on one such
/// copy at a time, so that neither ever waits for the other. It is all that there is to know: a map
/// that is made of it (Map) goes on as the one that it was copied from.
struct MapView {
  struct Keyframe {
    geometry::Pose world_from_camera;
    geometry::Pose camera_from_world;
    std::shared_ptr<const Pyramid> pyramid;
    double median_depth = 1.0;
    int points = 0;      ///< map points it sees
    double scale = 1.0;  ///< by which closing loops has multiplied the lengths around it
    geometry::Vector6d readout_twist = geometry::Vector6d::Zero();  ///< see geometry::FramePose
    KeyframeId tied_to = -1;                                        ///< see Map::Keyframe
    geometry::Similarity tied_from_this = {};                       ///< likewise

    /// Taken out of the map: has no picture and no points, but goes on moving with its neighbour.
    bool culled() const { return pyramid == nullptr; }

    /// For what hangs on the keyframe: lengths in its frame are in the unit of the time when it was
    /// added.
    geometry::Similarity world_from_keyframe() const { return {scale, world_from_camera}; }
  };
  struct Point {
    PointId id = -1;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in world
    std::uint32_t first_sighting = 0;                    ///< index into sightings
    std::uint32_t sightings = 0;
    int searched = 0;  ///< see Map::Point
    int found = 0;
  };

  std::uint64_t revision = 0;  ///< differs between any two published copies
  int loops_closed = 0;
  std::vector<Keyframe> keyframes;  ///< by KeyframeId
  std::vector<Point> points;        ///< by ascending id
  std::vector<Sighting> sightings;  ///< of all points, one after the other
  PointId next_point = 0;           ///< id of the next new point
};

/// The point with that id; null if the map has none.
const MapView::Point* find_point(const MapView& map, PointId id);

}  // namespace lumibox::tracking
