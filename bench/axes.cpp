#include "bench/axes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace lumibox::bench {
namespace {

constexpr Style kGrid{.stroke = "#e4e4e4"};
constexpr Style kFrame{.stroke = "#888"};
constexpr double kTickSize = 10.0;
constexpr double kLabelSize = 11.0;

std::vector<double> linear_ticks(const Range& range, int count) {
  const double rough = (range.high - range.low) / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double ratio = rough / power;
  const double step = power * (ratio <= 1.0 ? 1.0 : ratio <= 2.0 ? 2.0 : ratio <= 5.0 ? 5.0 : 10.0);
  std::vector<double> result;
  for (double i = std::ceil(range.low / step); i * step <= range.high; ++i) {
    result.push_back(i * step);
  }
  return result;
}

std::vector<double> logarithmic_ticks(const Range& range, int count) {
  const bool only_powers = std::log10(range.high / range.low) > 0.5 * count;
  std::vector<double> result;
  for (double power = std::floor(std::log10(range.low)); power <= std::log10(range.high); ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * std::pow(10.0, power);
      const bool inside = range.low <= value && value <= range.high;
      if (inside && (digit == 1.0 || !only_powers)) result.push_back(value);
    }
  }
  return result;
}

/// Position within the range, from 0 to 1.
double share(const Axis& axis, double value) {
  const Range& r = axis.range;
  return axis.scale == Scale::Linear ? (value - r.low) / (r.high - r.low)
                                     : std::log(value / r.low) / std::log(r.high / r.low);
}

}  // namespace

void Range::include(double value) {
  if (!std::isfinite(value)) return;
  low = std::min(low, value);
  high = std::max(high, value);
}

Range Range::padded(double share) const {
  if (empty()) return {0.0, 1.0};
  const double length = high - low;
  const double margin = length > 0.0 ? share * length : std::max(std::abs(low), 1.0) * 0.5;
  return {low - margin, high + margin};
}

std::vector<double> ticks(const Axis& axis, int count) {
  return axis.scale == Scale::Linear ? linear_ticks(axis.range, count)
                                     : logarithmic_ticks(axis.range, count);
}

std::string tick_label(double value) {
  // What is left of zero after adding steps up is no number to show.
  return std::abs(value) < 1e-12 ? "0" : fmt::format("{:.6g}", value);
}

Axes::Axes(const Vector2d& corner, const Vector2d& size, Axis x, Axis y)
    : corner_(corner), size_(size), x_(std::move(x)), y_(std::move(y)) {}

Vector2d Axes::at(double x, double y) const {
  return corner_ + Vector2d(share(x_, x) * size_.x(), (1.0 - share(y_, y)) * size_.y());
}

void Axes::draw(Svg& svg, const std::string& title) const {
  draw_x(svg);
  draw_y(svg);
  svg.rect(corner_, size_, kFrame);
  svg.text(corner_ - Vector2d(0.0, 6.0), title, {.size = 12.0, .bold = true});
}

void Axes::draw_x(Svg& svg) const {
  const double bottom = corner_.y() + size_.y();
  for (const double tick : ticks(x_, static_cast<int>(size_.x() / 70.0))) {
    const double x = at(tick, y_.range.low).x();
    svg.line({x, corner_.y()}, {x, bottom}, kGrid);
    if (x_.label.empty()) continue;
    svg.text({x, bottom + 14.0}, tick_label(tick), {.size = kTickSize, .anchor = Anchor::Middle});
  }
  svg.text({corner_.x() + 0.5 * size_.x(), bottom + 30.0}, x_.label,
           {.size = kLabelSize, .anchor = Anchor::Middle});
}

void Axes::draw_y(Svg& svg) const {
  for (const double tick : ticks(y_, std::max(2, static_cast<int>(size_.y() / 35.0)))) {
    const double y = at(x_.range.low, tick).y();
    svg.line({corner_.x(), y}, {corner_.x() + size_.x(), y}, kGrid);
    if (y_.label.empty()) continue;
    svg.text({corner_.x() - 5.0, y + 3.5}, tick_label(tick),
             {.size = kTickSize, .anchor = Anchor::End});
  }
  svg.text({corner_.x() - 44.0, corner_.y() + 0.5 * size_.y()}, y_.label,
           {.size = kLabelSize, .anchor = Anchor::Middle, .upwards = true});
}

}  // namespace lumibox::bench
