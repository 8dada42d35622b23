#pragma once

#include <limits>
#include <string>
#include <vector>

#include "bench/svg.h"

namespace lumibox::bench {

/// The numbers that an axis has to show; empty until it has been told any.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  bool empty() const { return !(low <= high); }
  void include(double value);  ///< numbers that are not finite are left out

  /// With a margin on both sides, a share of its length; something around it if it has none.
  Range padded(double share) const;
};

enum class Scale { Linear, Logarithmic };

struct Axis {
  std::string label;  ///< with its unit
  Range range;        ///< above 0 on a logarithmic axis
  Scale scale = Scale::Linear;
};

/// Round numbers within a range, about `count` of them: multiples of 1, 2 or 5 times a power of
/// ten; on a logarithmic axis powers of ten and, where these are few, 2 and 5 times them.
std::vector<double> ticks(const Axis& axis, int count);

/// A number as a tick shows it: six digits at most, none that say nothing.
std::string tick_label(double value);

/// A diagram's frame on a page: where numbers lie in it, and its axes.
class Axes {
 public:
  /// `corner` (upper left) and `size` are of the frame alone; labels need 55 pixels on the left, 35
  /// below, 20 above.
  Axes(const Vector2d& corner, const Vector2d& size, Axis x, Axis y);

  Vector2d at(double x, double y) const;

  /// Grid, frame, ticks, labels. Without a label the axis' numbers are left out too: diagrams above
  /// one another may share them.
  void draw(Svg& svg, const std::string& title) const;

  const Vector2d& corner() const { return corner_; }
  const Vector2d& size() const { return size_; }

 private:
  void draw_x(Svg& svg) const;
  void draw_y(Svg& svg) const;

  Vector2d corner_;
  Vector2d size_;
  Axis x_;
  Axis y_;
};

}  // namespace lumibox::bench
