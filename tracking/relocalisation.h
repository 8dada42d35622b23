#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "geometry/pose.h"
#include "tracking/map_tracking.h"

namespace lumibox::tracking {

/// A place at which a lost camera could be, and how many map points agree.
struct PossiblePlace {
  geometry::Pose camera_from_world;
  int inliers = 0;
};

/// What is known of a lost camera besides the picture.
struct LastSeen {
  geometry::Pose camera_from_world;
  double depth = 1.0;  ///< of what it saw, in units of the world
  double seconds_ago = 0.0;
};

/// Whether two estimates are of one place, in a scene of that depth.
bool is_same_place(const geometry::Pose& a_from_world, const geometry::Pose& b_from_world,
                   double depth);

/// Index of the place to believe: that with most points, unless a hand could not have got there in
/// the time, or another place explains the picture nearly as well. A label that repeats around a
/// can shows its front on its back; what was seen last tells them apart, and where that does not,
/// staying lost for now is better than a wrong pose. None if no place is to be believed.
std::optional<std::size_t> choose_place(std::span<const PossiblePlace> places,
                                        const LastSeen& last);

/// The same for a camera of which nothing is known besides the picture.
std::optional<std::size_t> choose_place(std::span<const PossiblePlace> places, double depth);

/// Whether a frame located from a guess has found so much of the map that the guess was right.
bool is_verified(const Localisation& found);

}  // namespace lumibox::tracking
