#include "lightfield/coverage.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/rotation.h"

namespace lumibox::lightfield {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kGate = 4.0 * kDegree;
constexpr double kWidestGap = 60.0 * kDegree;

/// Unit vector at a height above the horizon of y.
Vector3d toward(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kDegree;
  const double e = elevation_deg * kDegree;
  return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

/// Directions at one height, as far apart as a gate of 4 degrees lets them be taken.
std::vector<Vector3d> row(double from_deg, double to_deg, double elevation_deg) {
  std::vector<Vector3d> directions;
  const double step = 4.4 / std::cos(elevation_deg * kDegree);
  for (double azimuth = from_deg; azimuth < to_deg; azimuth += step) {
    directions.push_back(toward(azimuth, elevation_deg));
  }
  return directions;
}

Vector3d any_direction() {
  return toward(*rc::gen::inRange(0, 360), *rc::gen::inRange(-90, 91));
}

std::vector<Vector3d> any_directions() {
  std::vector<Vector3d> directions(static_cast<std::size_t>(*rc::gen::inRange(0, 60)));
  for (Vector3d& direction : directions) direction = any_direction();
  return directions;
}

/// By how much the plane with this normal through S (the origin) displaces a point that is seen
/// from `a` and projected onto it, as seen from `b`: an angle on b's image plane, in units of its
/// focal length. b looks at S.
double error_on_plane(const Vector3d& point, const Vector3d& a, const Vector3d& b,
                      const Vector3d& normal, double offset) {
  const Vector3d ray = point - a;
  const Vector3d shown = a + (offset - normal.dot(a)) / normal.dot(ray) * ray;
  const Vector3d forward = -b.normalized();
  const Vector3d right = Vector3d::UnitY().cross(forward).normalized();
  const auto x = [&](const Vector3d& p) { return (p - b).dot(right) / (p - b).dot(forward); };
  return std::abs(x(shown) - x(point));
}

// The formula against points of a sphere and two cameras, for angles small enough for it.
TEST(ExpectedGhosting, IsTheMeanOfTheWorstErrorsBeforeAndBehindThePlaneThroughS) {
  constexpr double kFocal = 500.0;
  const double angle = 0.1 * kDegree;
  for (const double share : {0.1, 0.35, 0.6}) {
    const double distance = 3.0;
    const Vector3d b = distance * Vector3d::UnitZ();
    const Vector3d a = distance * Vector3d(std::sin(angle), 0.0, std::cos(angle));
    double before = 0.0;
    double behind = 0.0;
    double best_plane = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const double z = 1.0 - (i + 0.5) / 1000.0;
      const double turn = 2.4 * i;
      const double across = std::sqrt(1.0 - z * z);
      const Vector3d point =
          share * distance * Vector3d(across * std::cos(turn), across * std::sin(turn), z);
      const double error = error_on_plane(point, a, b, Vector3d::UnitZ(), 0.0);
      (z > 0.0 ? before : behind) = std::max(z > 0.0 ? before : behind, error);
      best_plane = std::max(
          best_plane, error_on_plane(point, a, b, Vector3d::UnitZ(), distance * share * share));
    }
    const double expected = expected_ghosting(kFocal, angle, share);
    EXPECT_NEAR(kFocal * 0.5 * (before + behind), expected, 0.01 * expected) << share;
    EXPECT_NEAR(kFocal * best_plane, expected, 0.01 * expected) << share;
    EXPECT_NEAR(kFocal * before, kFocal * angle * share / (1.0 - share), 0.01 * expected);
  }
}

TEST(ExpectedGhosting, GrowsWithoutBoundsTowardsTheSphere) {
  EXPECT_EQ(expected_ghosting(500.0, kGate, 0.0), 0.0);
  EXPECT_EQ(expected_ghosting(500.0, 0.0, 0.5), 0.0);
  EXPECT_GT(expected_ghosting(500.0, kGate, 1.0 - 1e-9), 1e9);
  EXPECT_TRUE(std::isinf(expected_ghosting(500.0, kGate, 1.0)));
  EXPECT_TRUE(std::isinf(expected_ghosting(500.0, kGate, 3.0)));
}

TEST(HoleFinder, DirectionsShareTheSphereEvenly) {
  const HoleFinder finder;
  const auto& directions = finder.directions();
  for (const Vector3d& axis : {toward(0, 0), toward(50, 30), toward(200, -80), toward(0, 90)}) {
    for (const double radius_deg : {5.0, 30.0, 90.0}) {
      const auto within = std::ranges::count_if(directions, [&](const Vector3d& d) {
        return geometry::angle_between(d, axis) < radius_deg * kDegree;
      });
      const double share = 0.5 * (1.0 - std::cos(radius_deg * kDegree));
      EXPECT_NEAR(static_cast<double>(within), share * static_cast<double>(directions.size()),
                  3.0 + 0.02 * static_cast<double>(within));
    }
  }
}

TEST(HoleFinder, OfNothingOneOrAllDirectionsNothingIsMissing) {
  HoleFinder finder;
  EXPECT_EQ(finder.find({}, kGate, kWidestGap).missing, 0);
  EXPECT_FALSE(finder.find({}, kGate, kWidestGap).largest);
  EXPECT_EQ(finder.find({toward(10, 20)}, kGate, kWidestGap).missing, 0);
  EXPECT_EQ(finder.find({Vector3d::Zero()}, kGate, kWidestGap).missing, 0);
  EXPECT_EQ(finder.find({Vector3d(NAN, 0.0, 1.0)}, kGate, kWidestGap).missing, 0);
  std::vector<Vector3d> all;
  for (int elevation = -88; elevation <= 88; elevation += 4) {
    const auto at_height = row(0.0, 360.0, elevation);
    all.insert(all.end(), at_height.begin(), at_height.end());
  }
  EXPECT_EQ(finder.find(all, kGate, kWidestGap).missing, 0);
}

TEST(HoleFinder, ARowHasNoHoleBesideItAndNoneBeyondItsEnds) {
  HoleFinder finder;
  for (const double elevation : {0.0, 20.0, 35.0}) {
    EXPECT_EQ(finder.find(row(0.0, 90.0, elevation), kGate, kWidestGap).missing, 0) << elevation;
    EXPECT_EQ(finder.find(row(0.0, 360.0, elevation), kGate, kWidestGap).missing, 0) << elevation;
  }
}

TEST(HoleFinder, AFullRingWithAGapMissesTheGap) {
  HoleFinder finder;
  for (const double gap_deg : {20.0, 32.0, 44.0}) {
    const Holes holes = finder.find(row(gap_deg, 360.0, 20.0), kGate, kWidestGap);
    // A row of caps, 8 degrees wide, between the two ends that are covered.
    const double length_deg = gap_deg * std::cos(20.0 * kDegree) - 4.0;
    EXPECT_GE(holes.missing, static_cast<int>(length_deg / 16.0)) << gap_deg;
    EXPECT_LE(holes.missing, static_cast<int>(length_deg / 3.0)) << gap_deg;
    ASSERT_TRUE(holes.largest);
    EXPECT_LT(geometry::angle_between(*holes.largest, toward(0.5 * gap_deg - 2.0, 20.0)),
              5.0 * kDegree)
        << gap_deg;
  }
}

TEST(HoleFinder, AGapWiderThanTheWidestIsTheEndOfWhatIsCovered) {
  HoleFinder finder;
  const auto ring = row(50.0, 360.0, 0.0);
  EXPECT_GT(finder.find(ring, kGate, 60.0 * kDegree).missing, 2);
  EXPECT_EQ(finder.find(ring, kGate, 40.0 * kDegree).missing, 0);
}

TEST(HoleFinder, WhatLiesBetweenTwoRowsIsMissing) {
  HoleFinder finder;
  std::vector<Vector3d> rows = row(0.0, 60.0, 0.0);
  const auto above = row(0.0, 60.0, 24.0);
  rows.insert(rows.end(), above.begin(), above.end());
  const Holes holes = finder.find(rows, kGate, kWidestGap);
  // 16 degrees high and some 50 wide, in caps of 50 square degrees.
  EXPECT_NEAR(holes.missing, 16, 5);
  ASSERT_TRUE(holes.largest);
  const double elevation = std::asin(holes.largest->y()) / kDegree;
  EXPECT_NEAR(elevation, 12.0, 2.5);
}

TEST(HoleFinder, FineGatesOfAFullRowMissNothing) {
  HoleFinder finder;
  std::vector<Vector3d> directions;
  for (double azimuth = 0.0; azimuth < 90.0; azimuth += 0.55) {
    directions.push_back(toward(azimuth, 10.0));
  }
  EXPECT_EQ(finder.find(directions, 0.5 * kDegree, kWidestGap).missing, 0);
}

RC_GTEST_PROP(HoleFinder, APerspectiveMoreNeverRaisesWhatAFixedRegionMisses, ()) {
  static HoleFinder finder;
  std::vector<Vector3d> directions = any_directions();
  const double threshold = *rc::gen::inRange(2, 30) * kDegree;
  const auto region = finder.region(directions, threshold, kWidestGap);
  int before = finder.find_within(region, directions, threshold).missing;
  for (int i = 0; i < 5; ++i) {
    directions.push_back(any_direction());
    const int after = finder.find_within(region, directions, threshold).missing;
    RC_ASSERT(after <= before);
    before = after;
  }
}

RC_GTEST_PROP(HoleFinder, TheLargestHoleIsThePlaceOfTheRegionThatIsFarthestFromAll, ()) {
  static HoleFinder finder;
  const std::vector<Vector3d> directions = any_directions();
  const double threshold = *rc::gen::inRange(4, 20) * kDegree;
  const Holes holes = finder.find(directions, threshold, kWidestGap);
  RC_ASSERT(holes.largest.has_value() == (holes.missing > 0));
  if (!holes.largest) return;
  const auto from_all = [&](const Vector3d& place) {
    double least = 10.0;
    for (const Vector3d& d : directions) {
      least = std::min(least, geometry::angle_between(place, d));
    }
    return least;
  };
  const double farthest = from_all(*holes.largest);
  RC_ASSERT(farthest > threshold - 1e-5);
  for (const std::size_t i : finder.region(directions, threshold, kWidestGap)) {
    RC_ASSERT(from_all(finder.directions()[i]) < farthest + 1e-3);
  }
}

RC_GTEST_PROP(HoleFinder, OrderAndDistanceDoNotMatterNorWhatWasAskedBefore, ()) {
  static HoleFinder finder;
  std::vector<Vector3d> directions = any_directions();
  const Holes holes = finder.find(directions, kGate, kWidestGap);
  std::reverse(directions.begin(), directions.end());
  for (Vector3d& direction : directions) direction *= 3.0;
  HoleFinder fresh;
  const Holes again = fresh.find(directions, kGate, kWidestGap);
  RC_ASSERT(again.missing == holes.missing);
}

}  // namespace
}  // namespace lumibox::lightfield
