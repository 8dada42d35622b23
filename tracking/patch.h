#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "hal/image.h"

namespace lumibox::tracking {

/// Side of the square compared between pictures, pixels of a pyramid level. The patch is centred
/// between its four middle pixels.
inline constexpr int kPatch = 8;

/// A square of one picture resampled as another is expected to see it, with a border of one pixel
/// for its gradient.
struct PatchTemplate {
  static constexpr int kSide = kPatch + 2;
  std::array<float, kSide * kSide> values{};
  std::array<std::int16_t, kPatch * kPatch> core{};  ///< the values without border, rounded
  int sum = 0;                                       ///< of core
  int sum_squared = 0;                               ///< of core
};

/// Samples `image` around `center` (pixels of that image) at center + source_from_target * offset
/// for the offsets of a patch. None if that reaches beyond the image or the patch has no contrast.
std::optional<PatchTemplate> make_template(const hal::Image& image, const Eigen::Vector2d& center,
                                           const Eigen::Matrix2d& source_from_target);

/// Largest radius that search_square searches, pixels.
inline constexpr double kMaxSearchRadius = 40.0;

struct PatchMatch {
  Eigen::Vector2d pixel;     ///< of the patch's centre
  double correlation = 0.0;  ///< normalised, [-1, 1]
};

/// Best place for the template within `radius` pixels of `center` (kMaxSearchRadius at most), at
/// whole pixels, by normalised cross-correlation, which gain and offset of the exposure do not
/// change. None if all places lie outside the image or have no contrast.
std::optional<PatchMatch> search_square(const hal::Image& image, const PatchTemplate& patch,
                                        const Eigen::Vector2d& center, double radius);

/// Normalised cross-correlation of the template at one place (rounded to whole pixels); none
/// outside the image.
std::optional<double> correlation_at(const hal::Image& image, const PatchTemplate& patch,
                                     const Eigen::Vector2d& center);

/// Sub-pixel position of the template near `start` by inverse compositional alignment of
/// translation, gain and offset (Baker and Matthews, IJCV 2004). None if it does not converge or
/// wanders more than two pixels.
std::optional<Eigen::Vector2d> align_patch(const hal::Image& image, const PatchTemplate& patch,
                                           const Eigen::Vector2d& start);

}  // namespace lumibox::tracking
