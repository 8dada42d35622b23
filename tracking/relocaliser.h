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
/// descriptor matches to their points, P3P. Keyframes are described when they are first needed,
/// so it costs nothing while tracking goes well.
class Relocaliser {
 public:
  Relocaliser(const geometry::Camera& camera, const config::Tracking& options, std::uint32_t seed);
  ~Relocaliser();

  /// A pose that explains the frame; none if no keyframe matches. The caller must still verify it
  /// by tracking from there.
  std::optional<geometry::Pose> find(const MapView& map, const Pyramid& frame,
                                     const SmallImage& small);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::tracking
