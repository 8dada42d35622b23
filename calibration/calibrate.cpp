#include "calibration/calibrate.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "calibration/lens_fit.h"
#include "calibration/uncertainty.h"
#include "geometry/camera.h"
#include "geometry/robust.h"

namespace lumibox::calibration {
namespace {

using Reason = Refusal::Reason;

/// Views of one board and lens differ in error by a factor of two at most (0.15 to 0.24 px in
/// OpenCV's samples); corners of something else are many times as bad.
constexpr double kOutlierFactor = 3.0;

/// Of a focal length. A good set has a tenth of a percent; half a percent is a pixel and a half at
/// the side of a picture of 640.
constexpr double kLargestRelativeDeviation = 0.005;

double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

/// The sightings still in use, and the lens of them.
struct Kept {
  std::vector<std::size_t> places;  ///< among all sightings
  std::vector<Sighting> sightings;
  LensFit fit;
  std::vector<double> errors_px;
};

bool fit(const Request& request, Kept& kept) {
  const auto found =
      fit_lens(request.board, kept.sightings, request.width, request.height, request.model);
  if (!found) return false;
  kept.fit = *found;
  kept.errors_px.clear();
  for (std::size_t i = 0; i < kept.sightings.size(); ++i) {
    kept.errors_px.push_back(error_px(request.board, kept.sightings[i], kept.fit.profile,
                                      kept.fit.camera_from_board[i]));
  }
  return true;
}

std::optional<std::size_t> worst_outlier(const Kept& kept) {
  const auto worst = std::ranges::max_element(kept.errors_px);
  std::vector<double> errors_px = kept.errors_px;
  if (!(*worst > kOutlierFactor * geometry::upper_median(errors_px))) return std::nullopt;
  return static_cast<std::size_t>(worst - kept.errors_px.begin());
}

View view_of(const Kept& kept, std::size_t i) {
  return {tilt_of(kept.fit.camera_from_board[i]), kept.errors_px[i], false};
}

Refusal too_few(const Request& request, std::size_t found, std::size_t dropped) {
  std::string message = fmt::format("the board is in {} pictures", found);
  if (dropped > 0) message += fmt::format(", of which {} contradict the others", dropped);
  return {Reason::TooFewViews,
          fmt::format("{}; expected {} that agree", message, request.limits.min_views)};
}

/// Fits, drops the worst view, fits again, until the views agree: one bad view spoils the errors of
/// the good ones, so only the worst is known to be bad.
std::optional<Refusal> fit_without_outliers(const Request& request, Kept& kept,
                                            std::vector<View>& views) {
  while (true) {
    if (kept.sightings.size() < static_cast<std::size_t>(request.limits.min_views)) {
      return too_few(request, views.size(), views.size() - kept.sightings.size());
    }
    if (!fit(request, kept)) {
      return Refusal{
          Reason::NoLens,
          "no lens explains these views; expected a flat board of the given size, tilted "
          "in several ways"};
    }
    const auto outlier = request.keep_outliers ? std::nullopt : worst_outlier(kept);
    if (!outlier) return std::nullopt;
    View& view = views[kept.places[*outlier]];
    view = view_of(kept, *outlier);
    view.dropped = true;
    kept.places.erase(kept.places.begin() + static_cast<std::ptrdiff_t>(*outlier));
    kept.sightings.erase(kept.sightings.begin() + static_cast<std::ptrdiff_t>(*outlier));
  }
}

double total_error_px(const Kept& kept) {
  double sum = 0.0;
  double corners = 0.0;
  for (std::size_t i = 0; i < kept.sightings.size(); ++i) {
    const auto count = static_cast<double>(kept.sightings[i].size());
    sum += count * kept.errors_px[i] * kept.errors_px[i];
    corners += count;
  }
  return std::sqrt(sum / corners);
}

std::optional<Refusal> judge_coverage(const Request& request, std::span<const Sighting> sightings) {
  const std::string parts = uncovered_parts(coverage_of(sightings, request.width, request.height));
  if (parts.empty()) return std::nullopt;
  return Refusal{Reason::NotCovered,
                 fmt::format("the board's corners leave out parts of the picture: {}; expected {} "
                             "in each ninth",
                             parts, kFewestCornersInANinth)};
}

std::optional<Refusal> judge_tilts(const std::vector<geometry::Pose>& poses) {
  if (const double tilt = largest_tilt(poses); tilt < kLeastTilt) {
    return Refusal{Reason::BoardFrontal,
                   fmt::format("the board faces the camera in all pictures, tilted by {:.1f} "
                               "degrees at most; expected {:.0f} or more in some",
                               degrees(tilt), degrees(kLeastTilt))};
  }
  if (const double spread = tilt_spread(poses); spread < kLeastTiltSpread) {
    return Refusal{Reason::ViewsAlike,
                   fmt::format("the pictures are too alike: the board's tilts differ by {:.1f} "
                               "degrees at most; expected {:.0f}",
                               degrees(spread), degrees(kLeastTiltSpread))};
  }
  return std::nullopt;
}

std::optional<Refusal> judge_estimates(const std::vector<Estimate>& estimates) {
  for (const Estimate& estimate : estimates) {
    const double relative = estimate.deviation / estimate.value;
    if (!estimate.name.starts_with('f') || relative <= kLargestRelativeDeviation) continue;
    return Refusal{Reason::Uncertain,
                   fmt::format("{} is known to {:.1f} % only; expected {} %: more pictures, nearer "
                               "and more tilted",
                               estimate.name, 100.0 * relative, 100.0 * kLargestRelativeDeviation)};
  }
  return std::nullopt;
}

std::optional<Refusal> judge_fold(const config::CameraProfile& profile) {
  const auto corner = geometry::Camera(profile).corner_beyond_fold();
  if (!corner) return std::nullopt;
  return Refusal{Reason::LensFolds,
                 fmt::format("the distortion found turns back before pixel {:.0f}, {:.0f}; "
                             "expected corners of the board nearer to it, or --model fisheye",
                             corner->x(), corner->y())};
}

std::vector<Estimate> estimates_of(const Request& request, const Kept& kept) {
  const std::vector<double> deviations =
      standard_deviations(request.board, kept.sightings, kept.fit);
  std::vector<Estimate> estimates;
  for (const Parameter& parameter : parameters_of(request.model)) {
    estimates.push_back(
        {parameter.name, kept.fit.profile.*parameter.member, deviations[estimates.size()]});
  }
  return estimates;
}

}  // namespace

std::variant<Calibration, Refusal> calibrate(const Request& request,
                                             std::span<const Sighting> sightings) {
  if (sightings.size() < static_cast<std::size_t>(request.limits.min_views)) {
    return too_few(request, sightings.size(), 0);
  }
  if (const auto refusal = judge_coverage(request, sightings)) return *refusal;
  Calibration result;
  result.views.resize(sightings.size());
  Kept kept;
  kept.sightings.assign(sightings.begin(), sightings.end());
  for (std::size_t i = 0; i < sightings.size(); ++i) kept.places.push_back(i);
  if (const auto refusal = fit_without_outliers(request, kept, result.views)) return *refusal;
  if (const auto refusal = judge_coverage(request, kept.sightings)) return *refusal;

  result.error_px = total_error_px(kept);
  if (!(result.error_px <= request.limits.max_error_px)) {
    return Refusal{Reason::ErrorTooLarge,
                   fmt::format("reprojection error of {:.2f} px; expected {} px at most",
                               result.error_px, request.limits.max_error_px)};
  }
  result.estimates = estimates_of(request, kept);
  if (const auto refusal = judge_tilts(kept.fit.camera_from_board)) return *refusal;
  if (const auto refusal = judge_estimates(result.estimates)) return *refusal;
  if (const auto refusal = judge_fold(kept.fit.profile)) return *refusal;
  result.profile = kept.fit.profile;
  result.tilt_spread = tilt_spread(kept.fit.camera_from_board);
  for (std::size_t i = 0; i < kept.places.size(); ++i) {
    result.views[kept.places[i]] = view_of(kept, i);
  }
  return result;
}

}  // namespace lumibox::calibration
