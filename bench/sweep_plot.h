#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/svg.h"

namespace lumibox::bench {

/// One value of a setting, the median of its runs.
struct SweepPoint {
  double value = 0.0;
  bool is_default = false;
  double cost = 0.0;            ///< e.g. milliseconds
  std::optional<double> error;  ///< none: no truth, or too little tracked to compare
  double tracked_share = 1.0;
};

/// What a setting costs and brings on one footage, in ascending order of its value.
struct SweepCurve {
  std::string setting;
  std::string footage;
  std::vector<SweepPoint> points;
  std::string costs = "ms";        ///< label of the costs; diagrams of one label share their axes
  std::string buys = "error [%]";  ///< label of the errors
};

/// The knee: of the points that track as many frames as the best (to 5 %) and are at most 10 % less
/// accurate than the most accurate of these, the cheapest. None without errors.
std::optional<std::size_t> knee(const SweepCurve& curve);

/// A page with one diagram per setting: error over cost, a line per footage, the default
/// and the knee marked.
Svg draw_sweep(const std::string& title, const std::vector<SweepCurve>& curves);

}  // namespace lumibox::bench
