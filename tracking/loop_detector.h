#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "tracking/covisibility.h"
#include "tracking/keyframe_index.h"
#include "tracking/map.h"
#include "tracking/map_tracking.h"

namespace lumibox::tracking {

/// Two parts of the map that show the same place without knowing it.
struct Loop {
  /// A keyframe of the newer part, located by the points of the older one.
  struct Tie {
    KeyframeId keyframe = -1;
    /// Where it is as the older part has it; from its present frame, so the scale is that by which
    /// the newer part must grow.
    geometry::Similarity world_from_keyframe;
    std::vector<std::pair<PointId, Sighting>> sightings;  ///< of points of the older part
  };
  KeyframeId then = -1;   ///< keyframe of the older part
  std::vector<Tie> ties;  ///< those that agree; the first is the one looked from
};

/// How far a keyframe must be moved for a loop to close, and how far it can have drifted.
struct Drift {
  double length = 0.0;  ///< between the two places of the keyframe
  double turn = 0.0;    ///< radians
  double scale = 1.0;
};

/// Whether tracking can have drifted so far on that way. Another place that only looks the same
/// asks for more: the back of a can with a label on both sides for 0.6 of the way there at least.
bool is_plausible(const Drift& drift, const Way& way);

/// Finds places that are in the map twice: keyframes far apart in the map that look alike,
/// descriptor matches to the points of the one in the other and P3P, or the same place turned as
/// the small images say; then the search that tracks frames (localise), from several keyframes;
/// accepted if they agree, tracking can have drifted so far on the way between, and no other place
/// explains the picture nearly as well.
class LoopDetector {
 public:
  LoopDetector(const geometry::Camera& camera, const config::Tracking& options)
      : camera_(camera), localiser_(camera, options) {}

  /// The older place that keyframe `id` shows; none if there is none or too few of the keyframes
  /// around it (fewer than `min_ties`, itself included) see it as well. `graph` joins what is
  /// kConnected.
  std::optional<Loop> find(const Map& map, const CovisibilityGraph& graph, KeyframeId id,
                           std::size_t min_ties);

 private:
  struct Place;
  std::vector<KeyframeId> candidates(const Map& map, const CovisibilityGraph& graph, KeyframeId id,
                                     const std::vector<Way>& ways) const;
  std::optional<Place> locate(const Map& map, const MapView& view, KeyframeId id, KeyframeId then);
  std::vector<geometry::Pose> guesses(const Map& map, const MapView& view, KeyframeId id,
                                      KeyframeId then);
  std::vector<Loop::Tie> ties(const Map& map, KeyframeId id, const Place& place);

  geometry::Camera camera_;
  Localiser localiser_;
  KeyframeIndex index_;
};

}  // namespace lumibox::tracking
