#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "hal/image.h"

namespace lumibox::tracking {

/// A grey picture and its halvings, each the mean of 2x2 pixels of the one below: `levels` in all,
/// or as many as leave a pixel.
/// geometry::Camera::at_level() is the camera of a level.
class Pyramid {
 public:
  Pyramid() = default;
  Pyramid(const hal::Image& gray, int levels) { assign(gray, levels); }

  /// Becomes another picture's, in the memory that it has.
  void assign(const hal::Image& gray, int levels);

  int levels() const { return static_cast<int>(images_.size()); }
  const hal::Image& level(int index) const { return images_[static_cast<std::size_t>(index)]; }

 private:
  std::vector<hal::Image> images_;
};

/// Makes pyramids in the memory of those that nobody holds any more: a frame that does not become a
/// keyframe needs none of its own.
class PyramidPool {
 public:
  std::shared_ptr<const Pyramid> make(const hal::Image& gray, int levels);

 private:
  std::vector<std::shared_ptr<Pyramid>> pyramids_;
};

/// Position on a level of a level-0 pixel, and back. Pixel centres are integers on every level, so
/// the centre of level-1 pixel 0 is (0.5, 0.5) on level 0.
inline Eigen::Vector2d to_level(const Eigen::Vector2d& pixel, int level) {
  const double scale = 1.0 / static_cast<double>(1 << level);
  return (pixel.array() + 0.5) * scale - 0.5;
}
inline Eigen::Vector2d from_level(const Eigen::Vector2d& pixel, int level) {
  return (pixel.array() + 0.5) * static_cast<double>(1 << level) - 0.5;
}

}  // namespace lumibox::tracking
