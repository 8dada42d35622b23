#include "tracking/covisibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lumibox::tracking {
namespace {

/// Five keyframes in a row, one apart and each turned a tenth more; neighbours share three points,
/// the first and the last one.
Map row() {
  Map map;
  const auto pyramid = std::make_shared<const Pyramid>(hal::Image(32, 32, 1), 2);
  for (int i = 0; i < 5; ++i) {
    const geometry::Pose pose(geometry::exp_so3({0.0, 0.1 * i, 0.0}), Eigen::Vector3d(i, 0, 0));
    map.add_keyframe({pose.inverse(), {}}, pyramid);
  }
  const auto share = [&](KeyframeId a, KeyframeId b) {
    const PointId id = map.add_point({0.0, 0.0, 2.0});
    map.add_sighting(id, {a, Eigen::Vector2d::Zero(), 0});
    map.add_sighting(id, {b, Eigen::Vector2d::Zero(), 0});
  };
  for (KeyframeId k = 0; k < 4; ++k) {
    for (int i = 0; i < 3; ++i) share(k, k + 1);
  }
  share(4, 0);
  return map;
}

TEST(Covisibility, AnEdgeTakesAsManyPointsAsAskedFor) {
  const Map map = row();
  EXPECT_EQ(CovisibilityGraph(map, 4).edges().size(), 0U);
  EXPECT_EQ(CovisibilityGraph(map, 3).edges().size(), 4U);
  const CovisibilityGraph all(map, 1);
  ASSERT_EQ(all.edges().size(), 5U);
  EXPECT_EQ(all.edges()[1].a, 0);
  EXPECT_EQ(all.edges()[1].b, 4);
  EXPECT_EQ(all.edges()[1].shared, 1);
}

TEST(Covisibility, TheShortestWayIsFoundAndTurnsWithItsSteps) {
  const Map map = row();
  const std::vector<Way> along = CovisibilityGraph(map, 3).ways_from(0);
  EXPECT_NEAR(along[3].length, 3.0, 1e-12);
  EXPECT_NEAR(along[3].turn, 0.3, 1e-12);
  const std::vector<Way> around = CovisibilityGraph(map, 1).ways_from(1);
  EXPECT_NEAR(around[4].length, 3.0, 1e-12);
  EXPECT_EQ(around[1].length, 0.0);
}

TEST(Covisibility, AWayGoesNoLongStepsAndNotThroughAKeyframeLeftOut) {
  const Map map = row();
  EXPECT_TRUE(std::isinf(CovisibilityGraph(map, 3).ways_from(0, 1.5, 2)[3].length));
  EXPECT_TRUE(std::isinf(CovisibilityGraph(map, 1).ways_from(0, 3.5, 2)[3].length));
  EXPECT_NEAR(CovisibilityGraph(map, 1).ways_from(0, 4.5, 2)[3].length, 5.0, 1e-12);
}

}  // namespace
}  // namespace lumibox::tracking
