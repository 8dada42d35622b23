#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"

namespace lumibox::tracking {

/// Cameras, points and sightings to be adjusted together; sightings refer to both by index.
struct BundleProblem {
  struct View {
    geometry::Pose camera_from_world;
    bool fixed = false;
  };
  struct Observation {
    int view = 0;
    int point = 0;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< on level 0
    double sigma_px = 1.0;                            ///< expected error
    geometry::Pose row_from_frame;  ///< of a rolling shutter, see geometry::row_from_frame
    double error_in_sigma = 0.0;    ///< set by adjust: length of the residual
  };
  std::vector<View> views;
  std::vector<Eigen::Vector3d> points;  ///< in world
  std::vector<Observation> observations;
};

/// Minimises the Cauchy cost of all reprojection errors over the views not fixed and all points
/// (Triggs et al., "Bundle adjustment - a modern synthesis", 2000), single threaded and
/// deterministic. Points that move or are reflections fit no place: that cost lets go of them,
/// where one that grows linearly would let each pull for ever. Views should be fixed so that the
/// gauge is. The scale of the world does not matter. An observation of a point that starts behind
/// its view takes no part; one that ends there gets an infinite error. Returns false, with nothing
/// changed, if the solver failed. After each step `enough` may say that no more are wanted.
bool adjust(const geometry::Camera& camera, BundleProblem& problem, int max_iterations,
            const std::function<bool()>& enough = {});

}  // namespace lumibox::tracking
