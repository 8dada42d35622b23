#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "config/config.h"
#include "geometry/camera.h"
#include "geometry/pose.h"
#include "tracking/map_view.h"
#include "tracking/pyramid.h"
#include "tracking/rotation_prior.h"

namespace lumibox::tracking {

/// Finds the camera in a known map without knowing where it was: keyframes that look alike,
/// descriptor matches to their points, P3P. A keyframe is described when a frame first looks
/// like it, a few in one frame: that costs nothing while tracking goes well, and no frame takes
/// long.
class Relocaliser {
 public:
  Relocaliser(const geometry::Camera& camera, const config::Tracking& options, std::uint32_t seed);
  ~Relocaliser();

  /// For a frame that does not track well: describes some of the keyframes that it looks like, so
  /// that find() has them should tracking be lost.
  void prepare(const MapView& map, const SmallImage& small);

  /// Poses that explain the frame, from the keyframes that it matches best; more than one where
  /// parts of the scene look alike. The caller must still verify them by tracking from there. None
  /// while keyframes that look like the frame have still to be described: what they show may be a
  /// rival.
  std::vector<geometry::Pose> find(const MapView& map, const Pyramid& frame,
                                   const SmallImage& small);

  /// Keyframes described so far.
  int described() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::tracking
