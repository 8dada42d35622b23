#include "tracking/rotation_prior.h"

#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "tracking/textured_world.h"

namespace lumibox::tracking {
namespace {

SmallImage small_image_from(const Eigen::Vector3d& rotation_vector) {
  const geometry::Pose world_from_camera(geometry::exp_so3(rotation_vector),
                                         Eigen::Vector3d::Zero());
  return SmallImage(Pyramid(testing::render_wedge(testing::small_camera(), world_from_camera), 3));
}

// A prior has to bring points within the coarse search, which is tens of pixels wide: half a degree
// is three pixels of this camera.
TEST(RotationPrior, MeasuresAPureRotationAboutEachAxis) {
  const SmallImage last = small_image_from(Eigen::Vector3d::Zero());
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0.05, 0, 0), Eigen::Vector3d(0, 0.06, 0), Eigen::Vector3d(0, 0, 0.05),
        Eigen::Vector3d(-0.03, 0.04, 0.02)}) {
    const SmallImage current = small_image_from(turn);
    const RotationPrior prior = estimate_rotation(testing::small_camera(), last, current);
    const Eigen::Vector3d found = geometry::log_so3(prior.current_from_last);
    EXPECT_LT((found + turn).norm(), 0.012) << turn.transpose() << " found " << found.transpose();
  }
}

TEST(RotationPrior, FlatPicturesGiveNoRotation) {
  const SmallImage flat(Pyramid(hal::Image(320, 240, 1), 3));
  const RotationPrior prior = estimate_rotation(testing::small_camera(), flat, flat);
  EXPECT_LT(geometry::log_so3(prior.current_from_last).norm(), 1e-6);
}

}  // namespace
}  // namespace lumibox::tracking
