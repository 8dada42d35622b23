#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "hal/image.h"

namespace lumibox::render {

/// Stored values of a pixel of a three-channel picture.
inline Eigen::Vector3d texel(const hal::Image& image, int x, int y) {
  const std::uint8_t* rgb = image.at(x, y);
  return {static_cast<double>(rgb[0]), static_cast<double>(rgb[1]), static_cast<double>(rgb[2])};
}

/// Bilinear interpolation of the stored values; `pixel` lies within the outermost pixel centres.
inline Eigen::Vector3d sample_bilinear(const hal::Image& image, const Eigen::Vector2d& pixel) {
  const int x0 = static_cast<int>(pixel.x());
  const int y0 = static_cast<int>(pixel.y());
  const int x1 = std::min(x0 + 1, image.width() - 1);
  const int y1 = std::min(y0 + 1, image.height() - 1);
  const double a = pixel.x() - x0;
  const double b = pixel.y() - y0;
  return (1.0 - b) * ((1.0 - a) * texel(image, x0, y0) + a * texel(image, x1, y0)) +
         b * ((1.0 - a) * texel(image, x0, y1) + a * texel(image, x1, y1));
}

}  // namespace lumibox::render
