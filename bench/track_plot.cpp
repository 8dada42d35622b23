#include "bench/track_plot.h"

#include <optional>

#include "bench/map_views.h"
#include "bench/plot_colors.h"
#include "bench/time_plots.h"
#include "bench/trajectory.h"

namespace lumibox::bench {
namespace {

constexpr double kWidth = 1280.0;
constexpr double kMapHeight = 560.0;
constexpr double kMargin = 20.0;
constexpr double kLineHeight = 17.0;

/// Everything in the world of the truth.
TrackPlot moved(TrackPlot plot, const geometry::Similarity& truth_from_map) {
  for (auto* trajectory : {&plot.live, &plot.corrected}) {
    for (hal::StampedPose& pose : *trajectory) {
      pose.world_from_camera = truth_from_map * pose.world_from_camera;
    }
  }
  for (geometry::Pose& keyframe : plot.keyframes) keyframe = truth_from_map * keyframe;
  for (auto* points : {&plot.points, &plot.perspectives}) {
    for (Eigen::Vector3d& point : *points) point = truth_from_map * point;
  }
  return plot;
}

/// Title and figures; returns where the next line goes.
Vector2d draw_head(Svg& svg, const TrackPlot& plot) {
  Vector2d at(kMargin, 30.0);
  svg.text(at, plot.title, {.size = 18, .bold = true});
  at.y() += 6.0;
  for (const std::string& line : plot.figures) {
    at.y() += kLineHeight;
    svg.text(at, line, {.size = 12});
  }
  at.y() += 24.0;
  return at;
}

void draw_legend(Svg& svg, const TrackPlot& plot, Vector2d at) {
  const auto entry = [&](const std::string& name, const auto& draw) {
    draw(at - Vector2d(0.0, 4.0));
    svg.text(at + Vector2d(28.0, 0.0), name, {.size = 11});
    at.x() += 28.0 + 6.6 * static_cast<double>(name.size()) + 16.0;
  };
  const auto line = [&](const std::string& name, const Style& style) {
    entry(name, [&](const Vector2d& from) { svg.line(from, from + Vector2d(22.0, 0.0), style); });
  };
  const auto box = [&](const std::string& name, std::string_view color) {
    entry(name, [&](const Vector2d& from) {
      svg.rect(from + Vector2d(6.0, -5.0), {14.0, 10.0}, {.fill = color});
    });
  };
  line("final", {.stroke = colors::kFinal, .width = 2.0});
  line("live", {.stroke = colors::kLive, .width = 2.0});
  if (!plot.truth.empty()) {
    line("truth", {.stroke = colors::kTruth, .width = 3.0, .opacity = 0.4});
  }
  entry("keyframe, looking", [&](const Vector2d& from) {
    svg.line(from + Vector2d(6.0, 0.0), from + Vector2d(20.0, 0.0), {.stroke = colors::kFinal});
    svg.circle(from + Vector2d(6.0, 0.0), 2.2, {.stroke = colors::kFinal, .fill = "white"});
  });
  entry("map point", [&](const Vector2d& from) {
    svg.circle(from + Vector2d(14.0, 0.0), 1.5, {.fill = colors::kPoint});
  });
  if (!plot.perspectives.empty()) {
    entry("perspective", [&](const Vector2d& from) {
      svg.rect(from + Vector2d(10.0, -3.0), {6.0, 6.0}, {.fill = colors::kPerspective});
    });
  }
  line("no pose between", {.stroke = colors::kLost, .width = 2.0, .dashes = "4 3"});
  box("initialising", colors::kInitialising);
  box("good", colors::kGood);
  box("poor", colors::kPoor);
  box("lost", colors::kLost);
}

}  // namespace

Svg draw_track(const TrackPlot& plot) {
  const auto live = compare_trajectories(plot.live, plot.truth);
  const auto corrected = compare_trajectories(plot.corrected, plot.truth);
  const bool aligned = live && corrected;
  const std::string unit = aligned ? "units of the truth" : "median depths at the start";
  TrackPlot shown = aligned ? moved(plot, corrected->truth_from_estimate) : plot;
  std::vector<ErrorCurve> curves;
  if (aligned) {
    curves = {{live->by_pose, colors::kLive}, {corrected->by_pose, colors::kFinal}};
  } else {
    shown.truth.clear();  // it cannot be laid over the map
  }

  const double head = 60.0 + kLineHeight * static_cast<double>(plot.figures.size());
  Svg svg(kWidth, head + kMapHeight + 20.0 + time_plots_height(aligned) + kMargin);
  const Vector2d legend = draw_head(svg, shown);
  draw_legend(svg, shown, legend);
  draw_map_views(svg, shown, unit, {kMargin, head + 10.0}, {kWidth - 2.0 * kMargin, kMapHeight});
  draw_time_plots(svg, shown, curves, unit, {kMargin + 55.0, head + kMapHeight + 30.0},
                  kWidth - 2.0 * kMargin - 55.0);
  return svg;
}

}  // namespace lumibox::bench
