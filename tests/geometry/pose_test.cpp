#include "geometry/pose.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "geometry/two_view_scene.h"

namespace lumibox::geometry {
namespace {

using Eigen::Vector3d;

Pose random_pose(TwoViewScene* scene) {
  return Pose(exp_so3(scene->uniform(0.0, 3.1) * scene->direction()),
              scene->uniform(0.0, 10.0) * scene->direction());
}

// 1e-12: coordinates up to about 30, ten roundings.
RC_GTEST_PROP(Pose, FormsAGroup, (std::uint32_t seed)) {
  TwoViewScene scene(seed);
  const Pose a = random_pose(&scene);
  const Pose b = random_pose(&scene);
  const Pose c = random_pose(&scene);
  const Vector3d x = scene.direction();
  RC_ASSERT((((a * b) * c) * x - a * (b * (c * x))).norm() < 1e-12);
  RC_ASSERT(((a.inverse() * a) * x - x).norm() < 1e-12);
  RC_ASSERT(((a * b).inverse() * x - b.inverse() * (a.inverse() * x)).norm() < 1e-12);
  RC_ASSERT((a.matrix4() * x.homogeneous() - (a * x).homogeneous()).norm() < 1e-12);
}

RC_GTEST_PROP(Similarity, UmeyamaFindsTheSimilarityThatMadeTheTarget, (std::uint32_t seed)) {
  TwoViewScene scene(seed);
  const Similarity truth{scene.uniform(0.1, 10.0), random_pose(&scene)};
  Eigen::Matrix3Xd source(3, 12);
  Eigen::Matrix3Xd target(3, 12);
  for (int i = 0; i < 12; ++i) {
    source.col(i) = 3.0 * scene.direction();
    target.col(i) = truth * Vector3d(source.col(i));
  }
  const Similarity found = align_umeyama(source, target);
  RC_ASSERT(std::abs(found.scale - truth.scale) < 1e-12 * 10.0);
  RC_ASSERT((found.inverse() * (truth * Vector3d(1.0, 2.0, 3.0)) - Vector3d(1.0, 2.0, 3.0)).norm() <
            1e-10);
}

TEST(Similarity, UmeyamaOfAMirroredSetIsAProperRotation) {
  Eigen::Matrix3Xd source = Eigen::Matrix3Xd::Random(3, 10);
  Eigen::Matrix3Xd target = source;
  target.row(0) *= -1.0;
  EXPECT_NEAR(align_umeyama(source, target).rigid.matrix3().determinant(), 1.0, 1e-12);
}

}  // namespace
}  // namespace lumibox::geometry
