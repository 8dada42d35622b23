#pragma once

#include <cstddef>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"

namespace lumibox::render {

/// A small picture of a pinhole camera for comparing colours: three floats per pixel, 0 to 1.
struct SmallPicture {
  geometry::Camera camera;
  geometry::Pose world_from_camera;
  std::vector<float> rgb;

  int width() const { return camera.width(); }
  int height() const { return camera.height(); }
  const float* at(int x, int y) const {
    return &rgb[3 * static_cast<std::size_t>(y * width() + x)];
  }
};

/// How badly each pixel of a picture fits what others see, for each of some depths: a plane sweep
/// (Collins, "A space-sweep approach to true multi-image matching", CVPR 1996). Depths are evenly
/// spaced in inverse depth along the optical axis, from 0 to `nearest`.
class CostVolume {
 public:
  /// Mean absolute difference of colours, of the better half of the `others`, so that what hides a
  /// point from some of them does not count; smoothed over 3x3 pixels.
  CostVolume(const SmallPicture& picture, const std::vector<const SmallPicture*>& others,
             double nearest, int depths);

  int depths() const { return depths_; }
  double inverse_depth(double index) const { return nearest_ * index / (depths_ - 1); }

  /// Costs of all depths of a pixel, one after the other.
  float* at(int x, int y) { return &costs_[offset(x, y)]; }
  const float* at(int x, int y) const { return &costs_[offset(x, y)]; }

  /// The costs with those of a smooth surface around: a jump in depth costs less where the colours
  /// jump too (Hirschmueller, "Stereo processing by semiglobal matching", IEEE PAMI 2008, along
  /// rows and columns).
  CostVolume aggregated(const SmallPicture& picture) const;

 private:
  void sweep(const SmallPicture& picture, const std::vector<const SmallPicture*>& others);
  void smooth();
  void add_paths(const SmallPicture& picture, int dx, int dy, std::vector<float>& sum) const;
  std::size_t offset(int x, int y) const {
    return static_cast<std::size_t>(y * width_ + x) * static_cast<std::size_t>(depths_);
  }

  int width_;
  int height_;
  int depths_;
  double nearest_;
  std::vector<float> costs_;
};

}  // namespace lumibox::render
