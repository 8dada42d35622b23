#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"

namespace lumibox::lightfield {

/// A camera that points are seen by.
struct View {
  geometry::Pose camera_from_world;
  const geometry::Camera* camera = nullptr;
  double tolerance_px = 0.0;  ///< how far from its projection a point may be seen
};

/// Where a view saw something.
struct Observation {
  std::size_t view = 0;
  Eigen::Vector2d pixel;
  Eigen::Vector3d bearing;  ///< of the pixel, unit vector in the camera's frame
};

/// A point and the views that agree on it, ascending.
struct TrackPoint {
  Eigen::Vector3d position;  ///< in world
  std::vector<std::size_t> views;
};

/// The points that a track, observations thought to be of one point, is of: none if they agree on
/// none, several if matches have joined what does not belong together. Each point is seen by at
/// least three views within their tolerances, before all of them, and its distance is known to a
/// few percent. Method: of many pairs of observations, the point that most views agree with, then
/// least squares over these in inverse depth, in which points far away are regular.
std::vector<TrackPoint> triangulate_track(std::span<const View> views,
                                          std::vector<Observation> track);

}  // namespace lumibox::lightfield
