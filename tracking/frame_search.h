#pragma once

#include <vector>

#include "geometry/camera.h"
#include "geometry/rolling_shutter.h"
#include "tracking/map_view.h"
#include "tracking/point_matcher.h"
#include "tracking/pose_estimator.h"
#include "tracking/pyramid.h"

namespace lumibox::tracking {

/// How one pass looks for map points.
struct SearchPass {
  int min_level = 0;     ///< search on this level or coarser ones
  double radius = 4.0;   ///< pixels of the level searched
  int max_points = 700;  ///< spread over the picture
  double min_correlation = kMinCorrelation;
};

/// What a pass found; every point of `attempted` should be visible from the predicted pose.
struct SearchResult {
  std::vector<std::uint32_t> attempted;   ///< indices into MapView::points
  std::vector<Measurement> measurements;  ///< those found
};

/// Looks for the map's points in a frame around where `pose` predicts them.
SearchResult search_map(const geometry::Camera& camera, const MapView& map, const Pyramid& frame,
                        const geometry::FramePose& pose, const SearchPass& pass);

}  // namespace lumibox::tracking
