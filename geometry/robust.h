#pragma once

#include <span>
#include <vector>

namespace lumibox::geometry {

/// Weight of a residual in iteratively reweighted least squares with Tukey's biweight; 4.685 sigma
/// is 95 % efficient for Gaussian noise. 1 at zero, 0 from `limit` on. (Huber, "Robust
/// statistics", 1981.)
double tukey_weight(double residual, double limit);

/// The same with Huber's function: 1 up to `limit` (1.345 sigma for 95 %), then limit / |residual|.
double huber_weight(double residual, double limit);

/// Median, the mean of the two middle values for an even number; 0 for none. Takes a copy on
/// purpose: the values are reordered.
double median(std::vector<double> values);

/// The upper of the two middle values for an even number, in place: the values are reordered, and
/// no memory is taken. 0 for none.
double upper_median(std::span<double> values);

/// Median length of a vector of two independent Gaussian components, in their standard deviations.
inline constexpr double kMedianLength = 1.1774;

/// The value below which the share `share` of the values lies (nearest rank): 0.95 is the 95th
/// percentile, 1 the largest. 0 for none.
double quantile(std::vector<double> values, double share);

/// Standard deviation of zero-mean Gaussian residuals with outliers: 1.4826 times the median of
/// their magnitudes (Rousseeuw and Leroy, 1987). 0 for none.
double mad_sigma(std::span<const double> residuals);

}  // namespace lumibox::geometry
