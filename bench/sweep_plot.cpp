#include "bench/sweep_plot.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "bench/axes.h"
#include "bench/plot_colors.h"

namespace lumibox::bench {
namespace {

constexpr double kTrackedEnough = 0.95;  // of the frames that the best point tracks
constexpr double kNearBest = 1.1;        // of the error of the best point
constexpr std::size_t kColumns = 3;
constexpr double kWidth = 360.0;  // of a diagram's frame
constexpr double kHeight = 250.0;
constexpr double kLeft = 75.0;
constexpr double kTop = 100.0;
constexpr double kRowHeight = kHeight + 75.0;

constexpr std::string_view kColors[] = {colors::kFinal, colors::kLive, colors::kPerspective,
                                        colors::kLost};

/// Names in the order in which they first appear.
std::vector<std::string> names(const std::vector<SweepCurve>& curves,
                               std::string SweepCurve::*name) {
  std::vector<std::string> result;
  for (const SweepCurve& curve : curves) {
    if (std::ranges::find(result, curve.*name) == result.end()) result.push_back(curve.*name);
  }
  return result;
}

bool lost_any_frame(const SweepCurve& curve) {
  return std::ranges::any_of(curve.points, [](const auto& p) { return p.tracked_share < 1.0; });
}

double most_tracked(const SweepCurve& curve) {
  double most = 0.0;
  for (const SweepPoint& point : curve.points) most = std::max(most, point.tracked_share);
  return most;
}

/// The values, with the share of the frames tracked where that is too small to count. Points that
/// lie together share a label; labels are above and below in turn.
void draw_labels(Svg& svg, const Axes& axes, const SweepCurve& curve, std::string_view color) {
  constexpr double kTogether = 28.0;  // pixels
  std::string label;
  Vector2d first;
  double below = -8.0;
  const auto finish = [&] {
    if (!label.empty())
      svg.text(first + Vector2d(6.0, below), label, {.size = 9.5, .color = color});
    if (!label.empty()) below = below < 0.0 ? 16.0 : -8.0;
    label.clear();
  };
  for (const SweepPoint& point : curve.points) {
    if (!point.error) continue;
    const Vector2d at = axes.at(point.cost, *point.error);
    if (!label.empty() && (at - first).norm() > kTogether) finish();
    if (label.empty()) first = at;
    label += (label.empty() ? "" : ", ") + tick_label(point.value);
    if (point.tracked_share < kTrackedEnough * most_tracked(curve)) {
      label += fmt::format(" ({:.0f} %)", 100.0 * point.tracked_share);
    }
  }
  finish();
}

void draw_curve(Svg& svg, const Axes& axes, const SweepCurve& curve, std::string_view color) {
  std::vector<Vector2d> line;
  for (const SweepPoint& point : curve.points) {
    if (point.error) line.push_back(axes.at(point.cost, *point.error));
  }
  svg.polyline(line, {.stroke = color, .width = 1.4});
  const auto at_knee = knee(curve);
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const SweepPoint& point = curve.points[i];
    if (!point.error) continue;
    const Vector2d at = axes.at(point.cost, *point.error);
    svg.circle(at, 3.0, {.fill = color});
    if (point.is_default) svg.circle(at, 7.0, {.stroke = color, .width = 1.6});
    if (i == at_knee) {
      svg.rect(at - Vector2d(10.0, 10.0), {20.0, 20.0}, {.stroke = "#666", .dashes = "3 2"});
    }
  }
  draw_labels(svg, axes, curve, color);
}

/// The same for all diagrams of what costs the same kind of time, so that a large effect looks
/// larger than a small one.
std::pair<Axis, Axis> common_axes(const std::vector<SweepCurve>& curves, const SweepCurve& like) {
  Range cost{0.0, 1.0};
  Range error;
  for (const SweepCurve& curve : curves) {
    if (curve.costs != like.costs) continue;
    for (const SweepPoint& point : curve.points) {
      if (!point.error) continue;
      cost.include(1.15 * point.cost);
      if (*point.error > 0.0) error.include(*point.error);
    }
  }
  if (error.empty()) error = {0.1, 1.0};
  return {{like.costs, cost}, {like.buys, {0.7 * error.low, 1.5 * error.high}, Scale::Logarithmic}};
}

void draw_legend(Svg& svg, const std::vector<std::string>& footages, bool any_lost, Vector2d at) {
  const auto text = [&](const std::string& name) {
    svg.text(at + Vector2d(26.0, 4.0), name, {.size = 11});
    at.x() += 26.0 + 6.8 * static_cast<double>(name.size()) + 18.0;
  };
  for (std::size_t i = 0; i < footages.size(); ++i) {
    svg.line(at, at + Vector2d(20.0, 0.0), {.stroke = kColors[i % std::size(kColors)], .width = 2});
    text(footages[i]);
  }
  svg.circle(at + Vector2d(10.0, 0.0), 7.0, {.stroke = "black", .width = 1.6});
  text("default");
  svg.rect(at - Vector2d(-2.0, 8.0), {16.0, 16.0}, {.stroke = "#666", .dashes = "3 2"});
  text(std::string("knee: cheapest within 10 % of the least error") +
       (any_lost ? ", with 95 % of the frames tracked" : ""));
}

}  // namespace

std::optional<std::size_t> knee(const SweepCurve& curve) {
  const double most = most_tracked(curve);
  const auto counts = [&](const SweepPoint& point) {
    return point.error && point.tracked_share >= kTrackedEnough * most;
  };
  Range errors;
  for (const SweepPoint& point : curve.points) {
    if (counts(point)) errors.include(*point.error);
  }
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const SweepPoint& point = curve.points[i];
    if (!counts(point) || *point.error > kNearBest * errors.low) continue;
    if (!best || point.cost < curve.points[*best].cost) best = i;
  }
  return best;
}

Svg draw_sweep(const std::string& title, const std::vector<SweepCurve>& curves) {
  const std::vector<std::string> settings = names(curves, &SweepCurve::setting);
  const std::vector<std::string> footages = names(curves, &SweepCurve::footage);
  const std::size_t rows = (settings.size() + kColumns - 1) / kColumns;
  Svg svg(static_cast<double>(kColumns) * (kLeft + kWidth) + 25.0,
          kTop + static_cast<double>(rows) * kRowHeight);
  svg.text({20.0, 30.0}, title, {.size = 18, .bold = true});
  draw_legend(svg, footages, std::ranges::any_of(curves, lost_any_frame), {20.0, 56.0});
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const auto first = std::ranges::find(curves, settings[i], &SweepCurve::setting);
    const auto [x, y] = common_axes(curves, *first);
    const Vector2d cell(static_cast<double>(i % kColumns), static_cast<double>(i / kColumns));
    const Axes axes({kLeft + cell.x() * (kLeft + kWidth), kTop + cell.y() * kRowHeight},
                    {kWidth, kHeight}, x, y);
    axes.draw(svg, settings[i]);
    for (const SweepCurve& curve : curves) {
      if (curve.setting != settings[i]) continue;
      const auto index = std::ranges::find(footages, curve.footage) - footages.begin();
      draw_curve(svg, axes, curve, kColors[static_cast<std::size_t>(index) % std::size(kColors)]);
    }
  }
  return svg;
}

}  // namespace lumibox::bench
