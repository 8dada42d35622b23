#include "render/disagreement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/robust.h"

namespace lumibox::render {
namespace {

constexpr std::size_t kFewest = 6;  // that have a spread
constexpr double kLonely = 2.5;     // times the median angle to the nearest

/// Median and so many standard deviations, told from the median's magnitudes.
double beyond(const std::vector<double>& values, double sigmas) {
  const double middle = geometry::median(values);
  std::vector<double> residuals;
  for (const double value : values) residuals.push_back(value - middle);
  return middle + sigmas * geometry::mad_sigma(residuals);
}

/// The worse figure in units of its limit; 0 if neither could be told.
double excess(const Judgement& judgement, const Limits& limits) {
  return std::fmax(
      0.0, std::fmax(judgement.shift / limits.shift, judgement.difference / limits.difference));
}

}  // namespace

std::optional<Limits> limits_of(std::span<const Judged> judged, const config::Quality& options) {
  std::vector<double> nearest;
  for (const Judged& j : judged) nearest.push_back(j.nearest);
  const double lonely = kLonely * geometry::median(std::move(nearest));
  std::vector<double> shifts;
  std::vector<double> differences;
  for (const Judged& j : judged) {
    if (j.nearest > lonely || std::isnan(j.judgement.difference)) continue;
    shifts.push_back(j.judgement.shift);
    differences.push_back(j.judgement.difference);
  }
  if (shifts.size() < kFewest) return std::nullopt;
  return Limits{
      std::max(beyond(shifts, options.disagreement_sigmas),
               options.least_shift_deg * std::numbers::pi / 180.0),
      std::max(beyond(differences, options.disagreement_sigmas), options.least_difference), lonely};
}

bool stands_out(const Judged& judged, const Limits& limits) {
  return judged.nearest <= limits.lonely && excess(judged.judgement, limits) > 1.0;
}

double severity(const Judged& judged, const Limits& limits) {
  return stands_out(judged, limits) && judged.appeal ? excess(*judged.appeal, limits) : 0.0;
}

}  // namespace lumibox::render
