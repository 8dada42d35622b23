#pragma once

#include <cstdint>
#include <memory>
#include <optional>

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

  /// A pose that explains the frame; none if no keyframe matches. The caller must still verify it
  /// by tracking from there.
  std::optional<geometry::Pose> find(const MapView& map, const Pyramid& frame,
                                     const SmallImage& small);

  /// Keyframes described so far.
  int described() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::tracking
