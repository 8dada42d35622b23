#include "tracking/map.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tracking/covisibility.h"

namespace lumibox::tracking {
namespace {

class MapTest : public ::testing::Test {
 protected:
  MapTest() : pyramid_(std::make_shared<const Pyramid>(hal::Image(32, 32, 1), 2)) {
    for (int i = 0; i < 3; ++i) {
      map_.add_keyframe(geometry::Pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-i, 0, 0)),
                        pyramid_);
    }
    for (int i = 0; i < 4; ++i) {
      const PointId id = map_.add_point(Eigen::Vector3d(0, 0, 2 + i));
      map_.add_sighting(id, {0, Eigen::Vector2d(i, i), 0});
      if (i < 3) map_.add_sighting(id, {1, Eigen::Vector2d(i, i), 0});
      if (i < 1) map_.add_sighting(id, {2, Eigen::Vector2d(i, i), 0});
    }
  }
  std::shared_ptr<const Pyramid> pyramid_;
  Map map_;
};

TEST_F(MapTest, CovisibleKeyframesComeByPointsShared) {
  EXPECT_EQ(covisible_keyframes(map_, 0, 5), (std::vector<KeyframeId>{1, 2}));
  EXPECT_EQ(covisible_keyframes(map_, 0, 1), (std::vector<KeyframeId>{1}));
}

TEST_F(MapTest, ASightingIsAddedOnce) {
  map_.add_sighting(0, {1, Eigen::Vector2d(9, 9), 1});
  EXPECT_EQ(map_.point(0).sightings.size(), 3U);
}

TEST_F(MapTest, RemovingAPointLeavesNothingBehind) {
  map_.remove_point(0);
  EXPECT_FALSE(map_.has_point(0));
  for (const auto& keyframe : map_.keyframes()) {
    EXPECT_EQ(std::count(keyframe.points.begin(), keyframe.points.end(), 0), 0);
  }
  EXPECT_EQ(map_.add_point(Eigen::Vector3d::Zero()), 4);  // ids are never reused
}

TEST_F(MapTest, DepthIsTheMedianAndScales) {
  map_.update_depths();
  EXPECT_EQ(map_.keyframe(1).median_depth, 3.0);
  map_.scale(0.5);
  EXPECT_EQ(map_.keyframe(1).median_depth, 1.5);
  EXPECT_EQ(map_.keyframe(2).world_from_camera.translation.x(), 1.0);
}

TEST_F(MapTest, ACulledKeyframeMovesWithTheOneItIsTiedTo) {
  map_.cull_keyframe(2, 1);
  EXPECT_TRUE(map_.view(1).keyframes[2].culled());
  EXPECT_EQ(map_.point(0).sightings.size(), 2U);
  const geometry::Similarity before = map_.world_from_keyframe(2);
  EXPECT_EQ(before.rigid.translation, Eigen::Vector3d(2.0, 0.0, 0.0));
  map_.cull_keyframe(1, 0);
  EXPECT_FALSE(map_.has_point(0)) << "one sighting is none";
  const geometry::Pose moved(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 5.0, 0.0));
  map_.move_keyframe(0, {2.0, moved});
  for (const KeyframeId id : {1, 2}) {
    EXPECT_EQ(map_.keyframe(id).tied_to, 0);
    EXPECT_EQ(map_.view(2).keyframes[static_cast<std::size_t>(id)].world_from_camera.translation,
              Eigen::Vector3d(2.0 * id, 5.0, 0.0));
    EXPECT_EQ(map_.world_from_keyframe(id).scale, 2.0);
  }
}

TEST_F(MapTest, AViewHoldsEverythingOnce) {
  const MapView view = map_.view(17);
  EXPECT_EQ(view.revision, 17U);
  EXPECT_EQ(view.keyframes.size(), 3U);
  ASSERT_EQ(view.points.size(), 4U);
  EXPECT_EQ(view.sightings.size(), 8U);
  EXPECT_EQ(view.points[1].first_sighting, 3U);
  EXPECT_EQ(view.points[1].sightings, 2U);
}

}  // namespace
}  // namespace lumibox::tracking
