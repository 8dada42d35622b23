#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace lumibox::render {

/// Wide aperture, thesis 3.2: weight_i = (1 - penalty_i / limit)^exponent, normalised to sum 1.
/// `penalties` increase; `limit` is the penalty of the first perspective left out, so that one that
/// enters or leaves the set does so with weight 0. (The thesis' text has weight = penalty, which
/// would favour the far ones.) Exponent 0, and penalties that are all as large as the limit, give
/// equal weights. Negative exponents count as 0.
std::vector<double> wide_weights(const std::vector<double>& penalties, double limit,
                                 double exponent);

/// The limit above when no perspective is left out: where the next one would be if the centres went
/// on at the same density. On a surface the n-th nearest lies at an angle that grows as sqrt(n).
double limit_beyond(const std::vector<double>& penalties);

/// Small aperture, thesis 3.2: alpha of the perspective of rank `rank` (0 the nearest) out of `k`:
/// 1 for the nearest, `alpha` for the nearer half, from there linearly down to 0 for the last.
double small_alpha(std::size_t rank, std::size_t k, double alpha);

/// Wide aperture: a pixel's weighted sum of colours is divided by its sum of weights, or by this if
/// that is larger: half of an average layer's weight. Pixels that the layers hardly cover so fade
/// to black instead of being amplified. On a shape a twentieth: where a single picture reaches
/// there is nothing to smooth.
double least_total_weight(std::size_t layers, bool on_shape);

/// Width of the faded border in pixels of a picture of this size: `feather_px`, but never more than
/// a quarter of the shorter side, so that the middle of a small picture stays opaque.
double feather_width(int width, int height, double feather_px);

/// Thesis 3, faded borders: 0 on the outermost pixel centres and outside, 1 from feather_width on,
/// smooth between. A factor for the weight or alpha of the picture at this pixel.
double feather(const Eigen::Vector2d& pixel, int width, int height, double feather_px);

}  // namespace lumibox::render
