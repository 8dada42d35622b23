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
/// like it: that costs nothing while tracking goes well, and a lost frame only a few keyframes'
/// time.
class Relocaliser {
 public:
  Relocaliser(const geometry::Camera& camera, const config::Tracking& options, std::uint32_t seed);
  ~Relocaliser();

  /// Poses that explain the frame, one per keyframe that it matches; more than one where parts of
  /// the scene look alike. The caller must still verify them by tracking from there.
  std::vector<geometry::Pose> find(const MapView& map, const Pyramid& frame,
                                   const SmallImage& small);

  /// Keyframes described so far.
  int described() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::tracking
