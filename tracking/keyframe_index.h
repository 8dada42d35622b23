#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"
#include "tracking/corners.h"
#include "tracking/map_view.h"
#include "tracking/pyramid.h"
#include "tracking/rotation_prior.h"

namespace lumibox::tracking {

/// 256 comparisons of grey levels around a corner.
using Descriptor = std::array<std::uint64_t, 4>;

/// Corners of a picture and their upright binary descriptors (Rublee et al., "ORB", ICCV 2011): the
/// box is held upright, and without its orientation a descriptor tells more apart.
struct DescribedCorners {
  std::vector<Eigen::Vector2d> pixels;  ///< level 0
  std::vector<Descriptor> descriptors;  ///< one per pixel
};

/// Describes the corners that are far enough from the border.
DescribedCorners describe(const Pyramid& pyramid, const std::vector<Corner>& corners);

/// A corner of a picture (its index) and the map point that looks like it.
struct PointMatch {
  std::size_t corner = 0;
  PointId point = -1;
};

/// What the keyframes of a map look like, as a whole and at their points: for finding a place
/// again. A keyframe is described when something first looks like it: that costs nothing while
/// tracking goes well, and a lost frame only a few keyframes' time.
class KeyframeIndex {
 public:
  /// Takes in the small images of keyframes that are new, and lets go of those that are culled.
  void update(const MapView& map);

  /// Mean squared difference of grey levels between a picture and a keyframe, each small and with
  /// its mean removed. Precondition: update() has seen the keyframe, and it is not culled.
  double difference(const SmallImage& picture, KeyframeId keyframe) const;
  const SmallImage& small_image(KeyframeId keyframe) const;

  /// The `count` keyframes that look most like a picture, best first, of those that `eligible`
  /// allows.
  std::vector<KeyframeId> most_alike(const SmallImage& picture, std::size_t count,
                                     const std::function<bool(KeyframeId)>& eligible) const;

  /// The corners at which a keyframe sees map points, described, and the points.
  const DescribedCorners& corners(const MapView& map, KeyframeId keyframe);
  const std::vector<PointId>& points(const MapView& map, KeyframeId keyframe);

  /// Corners that look like one of the keyframe's points and clearly less like any other.
  std::vector<PointMatch> match(const MapView& map, KeyframeId keyframe,
                                const DescribedCorners& here);

  bool is_described(KeyframeId keyframe) const { return entry(keyframe).corners.has_value(); }

  /// Keyframes described so far.
  int described() const;

 private:
  struct Entry {
    SmallImage small;
    std::optional<DescribedCorners> corners;  // at the sightings of map points
    std::vector<PointId> points;              // one per corner
  };
  Entry& described_entry(const MapView& map, KeyframeId keyframe);
  const Entry& entry(KeyframeId id) const { return entries_[static_cast<std::size_t>(id)]; }

  std::vector<Entry> entries_;  // by KeyframeId
};

/// camera_from_world of a picture with these matched corners, by P3P with outliers; none if too few
/// matches agree on one.
std::optional<geometry::Pose> pose_from_matches(const geometry::Camera& camera, const MapView& map,
                                                const DescribedCorners& corners,
                                                const std::vector<PointMatch>& matches,
                                                std::uint32_t seed);

}  // namespace lumibox::tracking
