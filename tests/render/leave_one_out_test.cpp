#include "render/leave_one_out.h"

#include <gtest/gtest.h>

#include "render/ray_cast.h"
#include "render/reference.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

const lightfield::Sphere kSubject{Eigen::Vector3d::Zero(), 1.0};

TEST(LeaveOneOut, ComparesEachViewWithoutItself) {
  const auto perspectives =
      test::random_capture(test::textured_ball(1.0), test::make_camera(48, 36), 5, 4.0, 0.3, 9);
  std::size_t views = 0;
  const auto results = leave_one_out(
      perspectives, kSubject, {},
      [&](const View& view, const std::vector<Perspective>& others, const Method& method) {
        EXPECT_EQ(others.size(), 4U);
        for (const Perspective& other : others) {
          EXPECT_NE(other.center(), view.world_from_camera.translation);
        }
        return render_reference(view, others, method.settings);
      },
      [&](std::size_t index) { EXPECT_EQ(index, views++); });
  EXPECT_EQ(views, 5U);
  ASSERT_EQ(results.size(), 6U);
  EXPECT_EQ(results[0].method, "nearest");
  EXPECT_EQ(results[1].method, "plane-small");
  EXPECT_EQ(results[2].method, "plane-wide");
  EXPECT_EQ(results[3].method, "plane-sharp");
  EXPECT_EQ(results[4].method, "focal");
  EXPECT_EQ(results[5].method, "mesh");
  for (const MethodQuality& result : results) {
    ASSERT_EQ(result.views.size(), 5U);
    double sum = 0.0;
    for (const ViewQuality& view : result.views) sum += view.quality.psnr;
    EXPECT_NEAR(result.mean.psnr, sum / 5.0, 1e-9);
    EXPECT_GT(result.mean.psnr_subject, 10.0);
    EXPECT_GT(result.mean.ssim_subject, 0.1);
  }
}

// A renderer that knows the answer scores as high as a picture can, lens distortion or not.
TEST(LeaveOneOut, TheTruthScoresBest) {
  const test::World world = test::textured_ball(1.0);
  for (const bool distorted : {false, true}) {
    const auto perspectives =
        test::random_capture(world, test::make_camera(96, 72, distorted), 2, 4.0, 0.3, 9);
    const auto results =
        leave_one_out(perspectives, kSubject, {}, [&](const View& view, const auto&, const auto&) {
          return test::photograph(world, view.camera, view.world_from_camera);
        });
    EXPECT_GT(results[0].mean.psnr, distorted ? 33.0 : 98.0);
    EXPECT_GT(results[0].mean.ssim_subject, 0.97);
  }
}

TEST(LeaveOneOut, FewPerspectivesAreNoError) {
  const RenderView reference = [](const View& view, const std::vector<Perspective>& others,
                                  const Method& method) {
    return render_reference(view, others, method.settings);
  };
  EXPECT_EQ(leave_one_out({}, kSubject, {}, reference).size(), 6U);
  const auto one =
      test::random_capture(test::textured_ball(1.0), test::make_camera(48, 36), 1, 4.0, 0.3, 9);
  EXPECT_EQ(leave_one_out(one, kSubject, {}, reference)[0].views.size(), 1U);
}

TEST(Undistort, MarksWhatTheLensDidNotSee) {
  const auto perspectives = test::random_capture(test::textured_ball(1.0),
                                                 test::make_camera(96, 72, true), 1, 4.0, 0.3, 9);
  Perspective pincushion = perspectives[0];
  config::CameraProfile profile = pincushion.camera->profile();
  profile.k1 = 0.3;  // pulls the corners of the pinhole picture from outside the photograph
  pincushion.camera = std::make_shared<const geometry::Camera>(profile);
  const UndistortedPicture picture = undistort(pincushion);
  EXPECT_EQ(*picture.valid.at(48, 36), 255);
  EXPECT_EQ(*picture.valid.at(0, 0), 0);
}

}  // namespace
}  // namespace lumibox::render
