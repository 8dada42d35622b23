#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>

#include "geometry/camera.h"
#include "geometry/pose.h"
#include "lightfield/photo.h"

namespace lumibox::lightfield {

/// Where the subject is: the wireframe sphere of thesis 2.2; its centre is S.
struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< in world
  double radius = 1.0;                               ///< world units
  /// The map keyframe that the centre hangs on, as a perspective's pose does; -1 for none.
  int keyframe = -1;
  Eigen::Vector3d center_in_keyframe = Eigen::Vector3d::Zero();
};

/// One recorded picture and where it was taken, an element of the thesis' set C.
struct Perspective {
  int id = 0;  ///< unique within a capture, never reused
  geometry::Pose world_from_camera;
  std::int64_t timestamp_ns = 0;
  std::shared_ptr<Photo> photo;                    ///< as the camera gave it (distorted)
  std::shared_ptr<const geometry::Camera> camera;  ///< its intrinsics
  /// What its light is multiplied by so that it is as bright as its neighbours (render/exposure.h).
  double gain = 1.0;
  /// The map keyframe that the pose hangs on, so that a later correction of the map moves it;
  /// -1 for imported perspectives.
  int keyframe = -1;
  geometry::Pose keyframe_from_camera;
  std::string file;  ///< picture's path within the capture folder; empty if not stored

  /// True unless there is no picture, or none any more: views leave such a perspective out.
  bool can_be_shown() const { return camera && photo && !photo->fault(); }

  const Eigen::Vector3d& center() const { return world_from_camera.translation; }
};

}  // namespace lumibox::lightfield
