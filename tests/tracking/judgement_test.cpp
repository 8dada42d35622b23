#include "tracking/judgement.h"

#include <gtest/gtest.h>

#include "geometry/rotation.h"

namespace lumibox::tracking {
namespace {

/// Two hundred of three hundred points at a depth of 2 that hold the place to a thousandth of it.
Localisation firm() {
  Localisation found;
  found.attempted.resize(300);
  found.inliers = 200;
  found.median_depth = 2.0;
  found.position_sigma = 0.002;
  return found;
}

TEST(Judgement, ManyPointsThatHoldThePlaceAreTrusted) {
  EXPECT_EQ(trust_in(firm(), {}), Trust::Full);
}

TEST(Judgement, APoseHeldLooselyIsNotRecordedWithHoweverManyPointsThereAre) {
  Localisation loose = firm();
  loose.position_sigma = 0.005;
  EXPECT_EQ(trust_in(loose, {}), Trust::Place);
  loose.median_depth = 10.0;  // it is the share of the depth that counts
  EXPECT_EQ(trust_in(loose, {}), Trust::Full);
}

TEST(Judgement, WhereLittleOfTheMapShowsItMayBeAnotherPlace) {
  Localisation elsewhere = firm();
  elsewhere.attempted.resize(1000);
  EXPECT_EQ(trust_in(elsewhere, {}), Trust::Little);
}

TEST(Judgement, FewPointsAreTrustedLittleAndAHandfulNotAtAll) {
  Localisation few = firm();
  few.attempted.resize(40);
  few.inliers = 39;
  EXPECT_EQ(trust_in(few, {}), Trust::Little);
  few.inliers = 19;
  EXPECT_EQ(trust_in(few, {}), Trust::None);
}

// A localisation without a single inlier has no depth either.
TEST(Judgement, NothingFoundIsNotTrusted) {
  EXPECT_EQ(trust_in({}, {}), Trust::None);
}

// The expected pose is the hand's at constant velocity, a metre and a half from what it sees.
TEST(Judgement, AHandDoesNotJump) {
  const geometry::Pose tremor(geometry::exp_so3({0.0, 0.02, 0.0}), {0.02, 0.0, 0.0});
  EXPECT_TRUE(is_within_reach(tremor, 1.5));
  const geometry::Pose moved(Eigen::Quaterniond::Identity(), {0.15, 0.0, 0.0});
  EXPECT_FALSE(is_within_reach(moved, 1.5));
  EXPECT_TRUE(is_within_reach(moved, 15.0));  // of something far away that is nothing
  const geometry::Pose turned(geometry::exp_so3({0.0, 0.15, 0.0}), Eigen::Vector3d::Zero());
  EXPECT_FALSE(is_within_reach(turned, 1.5));
}

}  // namespace
}  // namespace lumibox::tracking
