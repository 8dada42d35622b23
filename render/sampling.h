#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

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

/// Bilinear interpolation of values on a grid, row by row; beyond the grid its border goes on.
template <class Value>
float sample_bilinear(const std::vector<Value>& values, int columns, int rows, float x, float y) {
  x = std::clamp(x, 0.0F, static_cast<float>(columns - 1));
  y = std::clamp(y, 0.0F, static_cast<float>(rows - 1));
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const int right = std::min(left + 1, columns - 1);
  const int bottom = std::min(top + 1, rows - 1);
  const float a = x - static_cast<float>(left);
  const float b = y - static_cast<float>(top);
  const auto value = [&](int column, int row) {
    return static_cast<float>(values[static_cast<std::size_t>(row * columns + column)]);
  };
  return (1.0F - b) * ((1.0F - a) * value(left, top) + a * value(right, top)) +
         b * ((1.0F - a) * value(left, bottom) + a * value(right, bottom));
}

/// Where the lowest of evenly spaced values lies between its neighbours, in steps from it: the
/// vertex of the parabola through the three. 0 if they make none.
inline double valley_offset(double below, double lowest, double above) {
  const double curvature = below + above - 2.0 * lowest;
  return std::isfinite(curvature) && curvature > 0.0 ? 0.5 * (below - above) / curvature : 0.0;
}

}  // namespace lumibox::render
