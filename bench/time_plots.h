#pragma once

#include <string>
#include <vector>

#include "bench/svg.h"
#include "bench/track_plot.h"
#include "bench/trajectory.h"

namespace lumibox::bench {

/// A trajectory's errors, by time, and the colour of its line.
struct ErrorCurve {
  std::vector<PoseError> errors;
  std::string_view color;
};

/// Diagrams one above the other with a common time axis: the errors (none without `curves`), the
/// points found, the time spent, the tracker's state. `unit` is that of the errors' distances.
void draw_time_plots(Svg& svg, const TrackPlot& plot, const std::vector<ErrorCurve>& curves,
                     const std::string& unit, const Vector2d& corner, double width);

/// Height that draw_time_plots() takes.
double time_plots_height(bool with_errors);

}  // namespace lumibox::bench
