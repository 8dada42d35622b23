#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "geometry/camera.h"
#include "tracking/pyramid.h"

namespace lumibox::tracking {

/// A picture so small and blurred that frames half a picture apart still align (Klein and Murray,
/// "Improving the Agility of Keyframe-Based SLAM", ECCV 2008, section 5).
class SmallImage {
 public:
  SmallImage() = default;
  explicit SmallImage(const Pyramid& pyramid) { assign(pyramid); }

  /// Becomes another picture's, in the memory that it has.
  void assign(const Pyramid& pyramid);

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return values_.empty(); }
  int scale() const { return scale_; }  ///< its pixels per level-0 pixel, inverted

  float at(int x, int y) const { return values_[static_cast<std::size_t>(y * width_ + x)]; }

  /// Standard deviation of the grey levels: how much there is to see.
  double contrast() const;

 private:
  void blur();

  int width_ = 0;
  int height_ = 0;
  int scale_ = 1;
  std::vector<float> values_;   ///< blurred, mean removed
  std::vector<float> blurred_;  ///< in one direction, while it is made
};

struct RotationPrior {
  Eigen::Quaterniond current_from_last = Eigen::Quaterniond::Identity();
  double residual = 0.0;  ///< root mean square of the aligned difference, grey levels
};

/// Rotation of the camera between two frames, from aligning their small images by shift and turn in
/// the image plane (second-order minimisation, Benhimane and Malis, 2007).
RotationPrior estimate_rotation(const geometry::Camera& camera, const SmallImage& last,
                                const SmallImage& current);

}  // namespace lumibox::tracking
