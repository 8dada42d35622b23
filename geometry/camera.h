#pragma once

#include <Eigen/Core>
#include <optional>

#include "config/camera_profile.h"

namespace lumibox::geometry {

/// A camera with one of the lenses of config::LensModel. Camera axes: x right, y down, z forward.
/// Pixel centres are at integer coordinates, the first at (0, 0). "Normalised" means on the plane
/// z = 1, without distortion; so a fisheye lens is known only where it looks forward.
class Camera {
 public:
  Camera() : Camera(config::CameraProfile{}) {}
  explicit Camera(const config::CameraProfile& profile);

  const config::CameraProfile& profile() const { return profile_; }
  int width() const { return profile_.width; }
  int height() const { return profile_.height; }
  bool has_distortion() const { return has_distortion_; }

  /// Pixel of a point in the camera's frame; none behind the camera or beyond the radius at which
  /// the distortion folds back on itself. The pixel may lie outside the image.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point_in_camera) const;

  /// The same with the 2x3 derivative of the pixel by the point.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point_in_camera,
                                         Eigen::Matrix<double, 2, 3>* jacobian) const;

  /// Normalised coordinates of a pixel (Newton's method, to 1e-12); none where no point before the
  /// camera maps to it.
  std::optional<Eigen::Vector2d> unproject(const Eigen::Vector2d& pixel) const;

  /// Distorted pixel of undistorted normalised coordinates, without the check for the fold.
  Eigen::Vector2d distort(const Eigen::Vector2d& normalised) const;

  /// Squared normalised radius at which the distortion first folds, of all directions; infinite if
  /// it never does, but 1e6 at most for a fisheye lens (89.9 degrees from the optical axis).
  double fold_radius2() const { return fold_radius2_; }

  /// A corner of the picture that the lens cannot show, since its distortion folds nearer to the
  /// middle; none of a lens that shows them all, and of a fisheye lens, which may see behind
  /// itself.
  std::optional<Eigen::Vector2d> corner_beyond_fold() const;

  /// Pixel of undistorted normalised coordinates, both homogeneous, as if there were no distortion.
  Eigen::Matrix3d pinhole_matrix() const;

  /// True if the pixel lies inside the image, at least `border` pixels from the outermost centres.
  bool contains(const Eigen::Vector2d& pixel, double border = 0.0) const {
    return pixel.x() >= border && pixel.y() >= border && pixel.x() <= profile_.width - 1 - border &&
           pixel.y() <= profile_.height - 1 - border;
  }

  /// The camera of the image halved `level` times by averaging 2x2 pixels: the centre of pixel 0 of
  /// level 1 lies between pixels 0 and 1 of level 0.
  Camera at_level(int level) const;

  /// The pinhole camera of the same intrinsics; of a fisheye's picture it sees the middle.
  Camera undistorted() const;

 private:
  config::CameraProfile profile_;
  bool has_distortion_ = false;
  double fold_radius2_ = 0.0;
};

}  // namespace lumibox::geometry
