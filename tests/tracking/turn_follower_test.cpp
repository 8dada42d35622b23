#include "tracking/turn_follower.h"

#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "support/pinhole.h"
#include "tracking/textured_world.h"

namespace lumibox::tracking {
namespace {

TEST(TurnFollower, TurningToAndFroTakesNoMoreMemory) {
  const geometry::Camera camera = lumibox::testing::pinhole(320, 240, 480.0);
  config::Tracking options;
  options.pyramid_levels = 3;
  const auto world_from_camera = [](int step) {
    return geometry::Pose(geometry::exp_so3({0.0, 0.03 * step, 0.0}), Eigen::Vector3d::Zero());
  };
  const auto picture = [&](int step) {
    return std::make_shared<const Pyramid>(testing::render_wedge(camera, world_from_camera(step)),
                                           3);
  };
  TurnFollower turn(camera, options);
  turn.start(picture(0), Eigen::Quaterniond::Identity());
  Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
  std::size_t after_first_sweep = 0;
  for (int sweep = 0; sweep < 3; ++sweep) {
    for (int i = 1; i <= 24; ++i) {
      const int step = i <= 12 ? i : 24 - i;
      const auto found = turn.follow(picture(step), last);
      ASSERT_TRUE(found) << sweep << ' ' << i;
      last = *found;
      // 3e-3 rad: a pixel and a half.
      EXPECT_LT(last.angularDistance(world_from_camera(step).rotation.conjugate()), 3e-3);
    }
    if (sweep == 0) after_first_sweep = turn.pictures();
  }
  EXPECT_GT(after_first_sweep, 2U);
  EXPECT_EQ(turn.pictures(), after_first_sweep);
}

}  // namespace
}  // namespace lumibox::tracking
