#pragma once

#include <optional>
#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "tracking/frame_search.h"
#include "tracking/map_view.h"

namespace lumibox::tracking {

/// A frame located in the map.
struct Localisation {
  geometry::FramePose pose;
  std::vector<std::uint32_t> attempted;   ///< points that should be visible
  std::vector<Measurement> measurements;  ///< points found; outliers are flagged
  int inliers = 0;

  double found_share() const {
    return attempted.empty() ? 0.0
                             : static_cast<double>(inliers) / static_cast<double>(attempted.size());
  }
};

/// Locates a frame near a predicted pose, coarse to fine: few points on coarse levels with a wide
/// search, then many with a narrow one (Klein and Murray, ISMAR 2007, section 5.5). None if the
/// coarse pass finds too little to go on with.
std::optional<Localisation> localise(const geometry::Camera& camera,
                                     const config::Tracking& options, const MapView& map,
                                     const Pyramid& frame, const geometry::FramePose& predicted);

}  // namespace lumibox::tracking
