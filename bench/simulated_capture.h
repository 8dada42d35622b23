#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "geometry/camera.h"
#include "hal/replay/sequence.h"
#include "hal/sim/scene.h"
#include "lightfield/perspective.h"
#include "render/view.h"

namespace lumibox::bench {

/// A scene's walk as it truly was, a pose for each of its frames.
struct Walk {
  std::shared_ptr<const geometry::Camera> camera;  ///< the scene's without its distortion
  std::vector<hal::StampedPose> poses;
  lightfield::Sphere subject;
};

Walk walk_of(const hal::Scene& scene);

/// Indices of the poses that the gate (thesis 2.3) records with this threshold, radians.
std::vector<std::size_t> recorded_along(const Walk& walk, double threshold);

/// Indices of at most `count` poses, spread over the walk, to be rendered from what was recorded:
/// each with the subject in its middle or at least in the picture, and in every one of the
/// `recorded` sets between the first and the last, and farther than `least_angle` (radians, at the
/// subject) from all. The same views judge all the sets. Fewer, or none, if there are not as many.
std::vector<std::size_t> unseen_along(const Walk& walk,
                                      const std::vector<std::vector<std::size_t>>& recorded,
                                      std::size_t count, double least_angle);

/// `count` places around the walk's subject, at the walk's mean distance and about equally spaced
/// on the sphere between 5 and 55 degrees above the level; the cameras look at the subject.
std::vector<hal::StampedPose> around_subject(const Walk& walk, std::size_t count);

/// A pose of around_subject()'s kind; angles in radians.
geometry::Pose pose_around(const Walk& walk, double azimuth, double elevation);

/// What is recorded at a pose: the simulator's own rays, no lens, sensor or shutter effects.
lightfield::Perspective record(const hal::Scene& scene, const Walk& walk, int id,
                               const hal::StampedPose& pose);

}  // namespace lumibox::bench
