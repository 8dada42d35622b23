#include "calibration/judgement.h"

#include <gtest/gtest.h>

#include <numbers>

namespace lumibox::calibration {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

geometry::Pose tilted(double about_x_deg, double about_y_deg) {
  const Eigen::Vector3d turn(about_x_deg * kDegree, about_y_deg * kDegree, 0.0);
  return {geometry::exp_so3(turn), Eigen::Vector3d(0.0, 0.0, 0.5)};
}

TEST(Coverage, CountsCornersInNinths) {
  const std::vector<Sighting> sightings{{{0, {0.0, 0.0}}, {1, {199.0, 0.0}}},
                                        {{0, {299.0, 149.0}}, {1, {150.0, 149.0}}}};
  const Coverage coverage = coverage_of(sightings, 300, 150);
  EXPECT_EQ(coverage[0], (std::array{1, 1, 0}));
  EXPECT_EQ(coverage[1], (std::array{0, 0, 0}));
  EXPECT_EQ(coverage[2], (std::array{0, 1, 1}));
}

TEST(Coverage, CornersJustOutsideCountAtTheBorder) {
  EXPECT_EQ(coverage_of(std::vector<Sighting>{{{0, {-0.8, 150.2}}}}, 300, 150)[2][0], 1);
}

TEST(Coverage, NamesWhatIsMissing) {
  Coverage coverage;
  for (auto& row : coverage) row.fill(kFewestCornersInANinth);
  EXPECT_EQ(uncovered_parts(coverage), "");
  coverage[0][0] = kFewestCornersInANinth - 1;
  coverage[1][1] = 0;
  coverage[2][1] = 0;
  EXPECT_EQ(uncovered_parts(coverage), "upper left, middle, lower middle");
}

TEST(Tilt, OfAFrontalBoardIsZeroHoweverItIsTurned) {
  const geometry::Pose turned(geometry::exp_so3({0.0, 0.0, 1.0}), Eigen::Vector3d(0.1, 0.2, 0.7));
  EXPECT_NEAR(tilt_of(turned), 0.0, 1e-12);
  const geometry::Pose from_behind(geometry::exp_so3({std::numbers::pi, 0.0, 0.0}),
                                   Eigen::Vector3d(0.1, 0.2, 0.7));
  EXPECT_NEAR(tilt_of(from_behind), 0.0, 1e-12);
}

TEST(Tilt, SpreadIsTheAngleBetweenThePlanes) {
  const std::vector<geometry::Pose> opposite{tilted(20.0, 0.0), tilted(0.0, 0.0),
                                             tilted(-15.0, 0.0)};
  EXPECT_NEAR(largest_tilt(opposite), 20.0 * kDegree, 1e-12);
  EXPECT_NEAR(tilt_spread(opposite), 35.0 * kDegree, 1e-12);
  EXPECT_NEAR(tilt_spread(std::vector{tilted(30.0, 0.0), tilted(30.0, 0.0)}), 0.0, 1e-12);
}

}  // namespace
}  // namespace lumibox::calibration
