#include "tracking/relocalisation.h"

#include <limits>

namespace lumibox::tracking {
namespace {

constexpr int kMinInliers = 40;          // points found, as for a good pose
constexpr double kMinFoundShare = 0.35;  // of the points that should be visible
constexpr double kSpeed = 1.5;      // depths per second: more than a hand or a walk around makes
constexpr double kReach = 0.3;      // depths, at once: what tracking was off by when it was lost
constexpr double kAlike = 0.6;      // of the inliers of the best place
constexpr double kSameTurn = 0.35;  // radians; nearer places are one
constexpr double kSamePlace = 0.2;  // depths

bool is_reachable(const PossiblePlace& place, const LastSeen& last) {
  const Eigen::Vector3d there = place.camera_from_world.inverse().translation;
  const Eigen::Vector3d here = last.camera_from_world.inverse().translation;
  return (there - here).norm() < (kReach + kSpeed * last.seconds_ago) * last.depth;
}

}  // namespace

bool is_same_place(const geometry::Pose& a_from_world, const geometry::Pose& b_from_world,
                   double depth) {
  const geometry::Pose motion = a_from_world * b_from_world.inverse();
  return motion.translation.norm() < kSamePlace * depth &&
         motion.rotation.angularDistance(Eigen::Quaterniond::Identity()) < kSameTurn;
}

std::optional<std::size_t> choose_place(std::span<const PossiblePlace> places,
                                        const LastSeen& last) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!is_reachable(places[i], last)) continue;
    if (!best || places[i].inliers > places[*best].inliers) best = i;
  }
  if (!best) return std::nullopt;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool rival =
        is_reachable(places[i], last) && places[i].inliers > kAlike * places[*best].inliers &&
        !is_same_place(places[i].camera_from_world, places[*best].camera_from_world, last.depth);
    if (rival) return std::nullopt;
  }
  return best;
}

std::optional<std::size_t> choose_place(std::span<const PossiblePlace> places, double depth) {
  return choose_place(places, {{}, depth, std::numeric_limits<double>::infinity()});
}

bool is_verified(const Localisation& found) {
  return found.inliers >= kMinInliers && found.found_share() >= kMinFoundShare;
}

}  // namespace lumibox::tracking
