#include "bench/rendering_curves.h"

#include <algorithm>
#include <cmath>

#include "geometry/robust.h"

namespace lumibox::bench {
namespace {

/// A kind of diagram: what is varied and what that costs.
struct Kind {
  std::string_view setting;
  const char* title;
  double QualityPoint::*cost;
};

constexpr Kind kKinds[] = {
    {"threshold_deg", "threshold [degrees], by what it records", &QualityPoint::perspectives},
    {"threshold_deg", "threshold [degrees], by time", &QualityPoint::cpu_ms},
    {"k", "pictures blended, by time", &QualityPoint::cpu_ms}};

template <typename T>
double median_over(const std::vector<QualityResult>& results, const T& value_of) {
  std::vector<double> values;
  for (const QualityResult& result : results) values.push_back(value_of(result));
  return geometry::median(values);
}

std::string costs_label(const Kind& kind, const std::string& method) {
  // Diagrams of one label share their axes; the methods' times are too far apart for that.
  return kind.cost == &QualityPoint::perspectives ? "perspectives recorded"
                                                  : method + ", processor time of a view [ms]";
}

/// In the order in which they first appear.
std::vector<std::string> methods(const std::vector<QualityPoint>& points) {
  std::vector<std::string> names;
  for (const QualityPoint& point : points) {
    const std::string& name = point.variation.method.name;
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

std::vector<SweepPoint> sweep(const std::vector<QualityPoint>& points, const std::string& method,
                              const Kind& kind) {
  std::vector<SweepPoint> result;
  for (const QualityPoint& point : points) {
    const RenderingVariation& v = point.variation;
    if (v.method.name != method || v.setting != kind.setting) continue;
    result.push_back({v.value, v.is_default, point.*kind.cost, grey_levels_from_psnr(point.psnr)});
  }
  return result;
}

}  // namespace

QualityPoint median_of(const RenderingVariation& variation,
                       const std::vector<QualityResult>& of_scenes) {
  const auto median = [&](const auto& value_of) { return median_over(of_scenes, value_of); };
  return {variation,
          median([](const auto& r) { return static_cast<double>(r.perspectives); }),
          median([](const auto& r) { return r.psnr; }),
          median([](const auto& r) { return r.ssim; }),
          median([](const auto& r) { return r.wall_ms.median; }),
          median([](const auto& r) { return r.cpu_ms.median; })};
}

double grey_levels_from_psnr(double psnr) {
  return 255.0 * std::pow(10.0, -psnr / 20.0);
}

std::vector<SweepCurve> quality_curves(const std::string& group,
                                       const std::vector<QualityPoint>& points) {
  std::vector<SweepCurve> curves;
  for (const Kind& kind : kKinds) {
    for (const std::string& method : methods(points)) {
      curves.push_back({method + ": " + kind.title, group, sweep(points, method, kind),
                        costs_label(kind, method), "RMS difference on the subject [grey levels]"});
    }
  }
  return curves;
}

std::vector<bool> knees(const std::vector<QualityPoint>& points) {
  std::vector<bool> result;
  for (const QualityPoint& point : points) {
    const auto kind = std::ranges::find(kKinds, point.variation.setting, &Kind::setting);
    const SweepCurve curve{"", "", sweep(points, point.variation.method.name, *kind)};
    const auto at = knee(curve);
    result.push_back(at && curve.points[*at].value == point.variation.value);
  }
  return result;
}

Svg draw_quality(const std::vector<SweepCurve>& curves) {
  return draw_sweep(
      "What likeness costs: difference between rendered and simulated views that nobody recorded",
      curves);
}

}  // namespace lumibox::bench
