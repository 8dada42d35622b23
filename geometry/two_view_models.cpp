#include "geometry/two_view_models.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "geometry/essential.h"
#include "geometry/homography.h"
#include "geometry/motion_refinement.h"
#include "geometry/sampling.h"

namespace lumibox::geometry {
namespace {

using Eigen::Matrix3d;

/// Iterations of the refinement of each new best sample; the result is refined to convergence.
constexpr int kQuickIterations = 4;
constexpr int kFullIterations = 20;
/// The set of inliers changes with the model; after this many rounds it has settled.
constexpr int kFullRounds = 4;

/// A model from few pairs is refined on all up to this many times an inlier's squared error (Chum,
/// Matas and Kittler, "Locally optimized RANSAC", 2003): its own inliers alone would hold it back.
constexpr double kNearFactor = 4.0;

constexpr double kLog4 = 2.0 * std::numbers::ln2;

// Each estimator below offers
//   kSample           pairs per sample
//   kFreeDimensions   coordinates of a point that the model leaves free, of the 4 that are observed
//   kParameters       of the model
//   solve(sample)     models through the sample
//   polish(...)       the model nearest to the one given that fits the flagged pairs best
//   Error(model)      a function from a pair to its squared error in radians^2

std::vector<BearingPair> select(std::span<const BearingPair> pairs,
                                const std::vector<bool>& flags) {
  std::vector<BearingPair> selected;
  selected.reserve(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (flags[i]) selected.push_back(pairs[i]);
  }
  return selected;
}

struct RotationEstimator {
  static constexpr std::size_t kSample = 2;
  static constexpr int kFreeDimensions = 2;
  static constexpr int kParameters = 3;

  static std::vector<Matrix3d> solve(std::span<const BearingPair> sample) {
    return {fit_rotation(sample).toRotationMatrix()};
  }
  static Matrix3d polish(const Matrix3d& start, std::span<const BearingPair> pairs,
                         const std::vector<bool>& use, int /*iterations*/) {
    const std::vector<BearingPair> used = select(pairs, use);
    return used.size() < kSample ? start : solve(used).front();
  }
  struct Error {
    explicit Error(const Matrix3d& r) : rotation(r) {}
    double operator()(const BearingPair& pair) const {
      return 0.5 * (rotation * pair.first - pair.second).squaredNorm();  // noise of both bearings
    }
    Matrix3d rotation;
  };
};

/// A rotation by nothing, that has nothing to estimate either.
struct NoMotion {
  static constexpr int kFreeDimensions = 2;
  static constexpr int kParameters = 0;
  using Error = RotationEstimator::Error;
};

struct HomographyEstimator {
  static constexpr std::size_t kSample = 4;
  static constexpr int kFreeDimensions = 2;
  static constexpr int kParameters = 8;

  static std::vector<Matrix3d> solve(std::span<const BearingPair> sample) {
    const auto homography = fit_homography(sample);
    // With middle singular value 1, a smaller determinant means a plane seen edge-on.
    if (!homography || !(std::abs(homography->determinant()) > 1e-3)) return {};
    return {*homography};
  }
  static Matrix3d polish(const Matrix3d& start, std::span<const BearingPair> pairs,
                         const std::vector<bool>& use, int /*iterations*/) {
    const std::vector<Matrix3d> refined = solve(select(pairs, use));
    return refined.empty() ? start : refined.front();
  }
  struct Error {
    explicit Error(const Matrix3d& h) : homography(h), inverse(h.inverse()) {}
    double operator()(const BearingPair& pair) const {
      return homography_error2(homography, inverse, pair);
    }
    Matrix3d homography;
    Matrix3d inverse;
  };
};

struct EssentialEstimator {
  static constexpr std::size_t kSample = 5;
  static constexpr int kFreeDimensions = 3;
  static constexpr int kParameters = 5;

  static std::vector<Matrix3d> solve(const std::array<BearingPair, 5>& sample) {
    return solve_essential(sample);
  }
  static Matrix3d polish(const Matrix3d& start, std::span<const BearingPair> pairs,
                         const std::vector<bool>& use, int iterations) {
    // All four motions of an essential matrix give the same one back.
    const Pose motion = motions_of_essential(start)[0];
    return essential_from_motion(refine_motion(motion, pairs, use, iterations));
  }
  struct Error {
    explicit Error(const Matrix3d& e) : essential(e) {}
    double operator()(const BearingPair& pair) const { return essential_error2(essential, pair); }
    Matrix3d essential;
  };
};

/// Finds the model with the lowest criterion by sampling.
template <typename Estimator>
class Ransac {
 public:
  Ransac(std::span<const BearingPair> pairs, double sigma_rad)
      : pairs_(pairs), inverse_variance_(1.0 / (sigma_rad * sigma_rad)) {
    best_.inliers.assign(pairs.size(), false);
    near_ = best_.inliers;
    best_.criterion = constant_cost() + kBound * static_cast<double>(pairs.size());
  }

  /// Takes the model over if it is better than the best so far.
  bool improve(const Matrix3d& model) {
    const typename Estimator::Error error(model);
    double cost = constant_cost();
    for (const BearingPair& pair : pairs_) {
      cost += std::min(error(pair) * inverse_variance_, kBound);
      if (!(cost < best_.criterion)) return false;
    }
    best_.model = model;
    best_.criterion = cost;
    best_.inlier_count = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const double variances = error(pairs_[i]) * inverse_variance_;
      near_[i] = variances < kNearFactor * kBound;
      best_.inliers[i] = variances < kBound;
      best_.inlier_count += best_.inliers[i] ? 1 : 0;
    }
    return true;
  }

  ModelFit run(const RansacOptions& options) {
    Sampler sampler(options.seed);
    int needed = options.max_samples;
    for (int i = 0; i < needed; ++i) {
      const auto indices = sampler.draw<Estimator::kSample>(pairs_.size());
      std::array<BearingPair, Estimator::kSample> sample;
      for (std::size_t k = 0; k < sample.size(); ++k) sample[k] = pairs_[indices[k]];
      bool improved = false;
      for (const Matrix3d& model : Estimator::solve(sample)) improved |= improve(model);
      if (!improved) continue;
      improve(Estimator::polish(best_.model, pairs_, near_, kQuickIterations));
      const double fraction =
          static_cast<double>(best_.inlier_count) / static_cast<double>(pairs_.size());
      needed = samples_needed(fraction, Estimator::kSample, options.max_samples);
    }
    for (int round = 0; round < kFullRounds && best_.inlier_count > 0; ++round) {
      if (!improve(Estimator::polish(best_.model, pairs_, near_, kFullIterations))) break;
    }
    return best_;
  }

  const ModelFit& best() const { return best_; }

 private:
  /// Squared error in variances from which a pair is an outlier.
  static constexpr double kBound = kOutlierCost - Estimator::kFreeDimensions * kLog4;

  /// What a model with no errors costs.
  double constant_cost() const {
    const auto count = static_cast<double>(pairs_.size());
    return Estimator::kParameters * std::log(4.0 * count) +
           Estimator::kFreeDimensions * kLog4 * count;
  }

  std::span<const BearingPair> pairs_;
  double inverse_variance_;
  ModelFit best_;
  std::vector<bool> near_;  ///< pairs that the model is refined on
};

}  // namespace

ModelFit assess_no_motion(std::span<const BearingPair> pairs, double sigma_rad) {
  Ransac<NoMotion> fit(pairs, sigma_rad);
  fit.improve(Matrix3d::Identity());
  return fit.best();
}

ModelFit find_rotation(std::span<const BearingPair> pairs, const RansacOptions& options) {
  return Ransac<RotationEstimator>(pairs, options.sigma_rad).run(options);
}

ModelFit find_homography(std::span<const BearingPair> pairs, const RansacOptions& options) {
  return Ransac<HomographyEstimator>(pairs, options.sigma_rad).run(options);
}

ModelFit find_essential(std::span<const BearingPair> pairs, const RansacOptions& options) {
  return Ransac<EssentialEstimator>(pairs, options.sigma_rad).run(options);
}

double essential_bound() {
  return kOutlierCost - EssentialEstimator::kFreeDimensions * kLog4;
}

}  // namespace lumibox::geometry
