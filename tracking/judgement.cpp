#include "tracking/judgement.h"

namespace lumibox::tracking {
namespace {

constexpr int kMinInliers = 20;      // fewer do not hold six degrees of freedom
constexpr int kMinGoodInliers = 40;  // fewer are not good enough to record with
// Of the camera's place, in its worst direction, by the depth of what it sees. What the errors of
// the map add is ten to twenty times this, so that at most some 2 % are left, or a degree at the
// subject: a quarter of the gate between two perspectives.
constexpr double kMaxPositionSigma = 0.0015;

// What a hand adds to its motion within a thirtieth of a second: 10 m/s^2 are a centimetre, and the
// subject is half a metre away or more; and as much seen as a turn, twice.
constexpr double kReach = 0.04;      // of the depth
constexpr double kReachTurn = 0.07;  // radians

}  // namespace

Trust trust_in(const Localisation& found, const config::Tracking& options) {
  if (found.inliers < kMinInliers) return Trust::None;
  if (found.inliers < kMinGoodInliers || found.found_share() < options.lost_inlier_share) {
    return Trust::Little;
  }
  const bool held = found.position_sigma < kMaxPositionSigma * found.median_depth;
  return held ? Trust::Full : Trust::Place;
}

bool is_within_reach(const geometry::Pose& found_from_expected, double depth) {
  return found_from_expected.translation.norm() < kReach * depth &&
         found_from_expected.rotation.angularDistance(Eigen::Quaterniond::Identity()) < kReachTurn;
}

}  // namespace lumibox::tracking
