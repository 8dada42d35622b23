#include "bench/time_plots.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "bench/axes.h"
#include "bench/plot_colors.h"

namespace lumibox::bench {
namespace {

using tracking::TrackingState;

constexpr double kErrorHeight = 110.0;
constexpr double kSmallHeight = 80.0;
constexpr double kStateHeight = 26.0;
constexpr double kGap = 30.0;    // between diagrams; holds a title
constexpr double kBelow = 40.0;  // the last one's ticks and label
constexpr double kBreakS = 0.25;

/// Frames in a row of one state and reason; ends where the next begins.
struct Stretch {
  TrackingState state;
  tracking::TrackingReason reason;
  double begin_s;
  double end_s;
};

std::vector<Stretch> stretches(const std::vector<PlottedFrame>& frames) {
  std::vector<Stretch> result;
  for (const PlottedFrame& frame : frames) {
    if (!result.empty()) result.back().end_s = frame.timestamp_s;
    if (result.empty() || result.back().state != frame.state ||
        result.back().reason != frame.reason) {
      result.push_back({frame.state, frame.reason, frame.timestamp_s, frame.timestamp_s});
    }
  }
  return result;
}

std::string_view color_of(TrackingState state) {
  switch (state) {
    case TrackingState::Initialising:
      return colors::kInitialising;
    case TrackingState::Good:
      return colors::kGood;
    case TrackingState::Poor:
      return colors::kPoor;
    case TrackingState::Lost:
      return colors::kLost;
  }
  return "none";
}

/// The diagrams below one another; each takes its place below the one before.
class Stack {
 public:
  Stack(Svg& svg, const TrackPlot& plot, const Vector2d& corner, double width)
      : svg_(svg), next_(corner), width_(width), stretches_(stretches(plot.frames)) {
    start_s_ = plot.frames.empty() ? 0.0 : plot.frames.front().timestamp_s;
    for (const PlottedFrame& frame : plot.frames) time_.include(frame.timestamp_s - start_s_);
    time_ = time_.padded(0.0);
  }

  /// Lines of (seconds, value), broken where nothing is known for a while.
  struct Line {
    std::vector<Vector2d> values;
    std::string_view color;
  };
  void draw(const std::string& title, const Axis& y, double height,
            const std::vector<Line>& lines) {
    const Axes axes(next_, {width_, height}, {"", time_}, y);
    shade(axes);
    axes.draw(svg_, title);
    svg_.clip(axes.corner(), axes.size());
    for (const Line& line : lines) draw(axes, line);
    svg_.unclip();
    next_.y() += height + kGap;
  }

  void draw_states() {
    const Axes axes(next_, {width_, kStateHeight}, {"time since the first frame [s]", time_},
                    {"", {0.0, 1.0}});
    axes.draw(svg_, "State, and why it is not good");
    for (const Stretch& stretch : stretches_) {
      const double left = axes.at(stretch.begin_s - start_s_, 0.0).x();
      const double right = axes.at(stretch.end_s - start_s_, 0.0).x();
      // A single frame must still be seen.
      const double width = std::max(right - left, 1.0);
      svg_.rect({left, next_.y()}, {width, kStateHeight}, {.fill = color_of(stretch.state)});
      const std::string reason = tracking::advice(stretch.reason);
      if (4.8 * static_cast<double>(reason.size()) > width) continue;
      svg_.text({left + 3.0, next_.y() + 0.5 * kStateHeight + 3.5}, reason, {.size = 9});
    }
  }

 private:
  void shade(const Axes& axes) {
    for (const Stretch& stretch : stretches_) {
      if (stretch.state == TrackingState::Good) continue;
      const double left = axes.at(stretch.begin_s - start_s_, 0.0).x();
      const double right = axes.at(stretch.end_s - start_s_, 0.0).x();
      svg_.rect({left, axes.corner().y()}, {std::max(right - left, 1.0), axes.size().y()},
                {.fill = color_of(stretch.state), .opacity = 0.25});
    }
  }

  void draw(const Axes& axes, const Line& line) {
    std::vector<Vector2d> points;
    for (std::size_t i = 0; i < line.values.size(); ++i) {
      if (i > 0 && line.values[i].x() - line.values[i - 1].x() > kBreakS) {
        points.emplace_back(Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
      }
      points.push_back(axes.at(line.values[i].x() - start_s_, line.values[i].y()));
    }
    svg_.polyline(points, {.stroke = line.color, .width = 1.2});
  }

  Svg& svg_;
  Vector2d next_;
  double width_;
  std::vector<Stretch> stretches_;
  double start_s_ = 0.0;
  Range time_;
};

/// A logarithmic axis: errors after a loss must not flatten all others.
void draw_errors(Stack& stack, const std::vector<ErrorCurve>& curves, const std::string& title,
                 const std::string& label, double height, double PoseError::*part) {
  std::vector<double> values;
  std::vector<Stack::Line> lines;
  for (const ErrorCurve& curve : curves) {
    Stack::Line line{{}, curve.color};
    for (const PoseError& error : curve.errors) {
      line.values.emplace_back(error.timestamp_s, error.*part);
      values.push_back(error.*part);
    }
    lines.push_back(std::move(line));
  }
  Range range;
  for (const double value : values) {
    if (value > 0.0) range.include(value);
  }
  if (range.empty()) range = {0.1, 1.0};
  // A few poses that are right by chance would stretch the axis over many decades.
  const Range shown{std::max(range.low, 1e-3 * range.high) * 0.9, range.high * 1.2};
  stack.draw(title, {label, shown, Scale::Logarithmic}, height, lines);
}

Stack::Line numbers(const TrackPlot& plot, const std::function<double(const PlottedFrame&)>& of) {
  Stack::Line line{{}, colors::kTruth};
  for (const PlottedFrame& frame : plot.frames)
    line.values.emplace_back(frame.timestamp_s, of(frame));
  return line;
}

void draw_points_found(Stack& stack, const TrackPlot& plot) {
  Range range{0.0, 10.0};
  for (const PlottedFrame& frame : plot.frames) range.include(1.05 * frame.measurements);
  stack.draw("Map points found", {"[points]", range}, kSmallHeight,
             {numbers(plot, [](const PlottedFrame& frame) { return frame.measurements; })});
}

/// Logarithmic too: in lockstep the mapper's work stands out by a hundred times.
void draw_times(Stack& stack, const TrackPlot& plot) {
  Range range{1.0, 20.0};
  for (const PlottedFrame& frame : plot.frames) range.include(1.2 * frame.ms);
  stack.draw("Time in the tracker, without --realtime in the mapper too",
             {"[ms]", {std::max(range.low, 0.1), range.high}, Scale::Logarithmic}, kSmallHeight,
             {numbers(plot, [](const PlottedFrame& frame) { return std::max(frame.ms, 0.1); })});
}

}  // namespace

void draw_time_plots(Svg& svg, const TrackPlot& plot, const std::vector<ErrorCurve>& curves,
                     const std::string& unit, const Vector2d& corner, double width) {
  Stack stack(svg, plot, corner, width);
  if (!curves.empty()) {
    draw_errors(stack, curves, "Error of the position", "[" + unit + "]", kErrorHeight,
                &PoseError::distance);
    draw_errors(stack, curves, "Error of the orientation", "[degrees]", kSmallHeight,
                &PoseError::rotation_deg);
  }
  draw_points_found(stack, plot);
  draw_times(stack, plot);
  stack.draw_states();
}

double time_plots_height(bool with_errors) {
  const double errors = with_errors ? kErrorHeight + kSmallHeight + 2.0 * kGap : 0.0;
  return errors + 2.0 * (kSmallHeight + kGap) + kStateHeight + kBelow;
}

}  // namespace lumibox::bench
