#include "tracking/judgement.h"

namespace lumibox::tracking {
namespace {

constexpr int kMinInliers = 20;      // fewer do not hold six degrees of freedom
constexpr int kMinGoodInliers = 40;  // fewer are not good enough to record with
// Of the camera's place, in its worst direction, by the depth of what it sees. What the errors of
// the map add is ten to twenty times this, so that at most some 2 % are left, or a degree at the
// subject: a quarter of the gate between two perspectives.
constexpr double kMaxPositionSigma = 0.0015;

}  // namespace

Trust trust_in(const Localisation& found, const config::Tracking& options) {
  if (found.inliers < kMinInliers) return Trust::None;
  if (found.inliers < kMinGoodInliers || found.found_share() < options.lost_inlier_share) {
    return Trust::Little;
  }
  const bool held = found.position_sigma < kMaxPositionSigma * found.median_depth;
  return held ? Trust::Full : Trust::Place;
}

}  // namespace lumibox::tracking
