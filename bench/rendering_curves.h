#pragma once

#include <string>
#include <vector>

#include "bench/rendering_quality.h"
#include "bench/sweep_plot.h"

namespace lumibox::bench {

/// A variation in the scenes that are judged together: medians over them.
struct QualityPoint {
  RenderingVariation variation;
  double perspectives = 0.0;
  double psnr = 0.0;  ///< dB on the subject
  double ssim = 0.0;
  double wall_ms = 0.0;  ///< median of a view
  double cpu_ms = 0.0;   ///< likewise
};

/// Precondition: there is a result.
QualityPoint median_of(const RenderingVariation& variation,
                       const std::vector<QualityResult>& of_scenes);

/// Root mean square difference in grey levels that a PSNR stands for.
double grey_levels_from_psnr(double psnr);

/// What the points say, all of one group of scenes: of each method how the difference on the
/// subject falls with the perspectives recorded, and what it costs in processor time, once by the
/// gate's threshold, once by the pictures blended.
std::vector<SweepCurve> quality_curves(const std::string& group,
                                       const std::vector<QualityPoint>& points);

/// Of each point whether it is the knee of its method's setting: of the threshold by what it
/// records, of the pictures blended by time.
std::vector<bool> knees(const std::vector<QualityPoint>& points);

/// A page of such curves of several groups.
Svg draw_quality(const std::vector<SweepCurve>& curves);

}  // namespace lumibox::bench
