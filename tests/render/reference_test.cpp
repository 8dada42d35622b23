#include "render/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "render/image_quality.h"
#include "render/ray_cast.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;
using test::look_at;
using test::make_camera;

/// Cameras side by side with parallel axes before a plane through the origin.
std::vector<Perspective> parallel_row(const test::World& world, const geometry::Camera& camera,
                                      int count) {
  std::vector<Perspective> perspectives;
  for (int i = 0; i < count; ++i) {
    const geometry::Pose pose(Eigen::Quaterniond::Identity(),
                              {0.2 * (i % 5 - 2), 0.2 * (i / 5 - 1), -3.0});
    perspectives.push_back(test::photograph_perspective(i, world, camera, pose));
  }
  return perspectives;
}

/// Mask of the middle of a picture, where all of a row of cameras see.
hal::Image middle(int width, int height) {
  hal::Image mask(width, height, 1);
  for (int y = height / 4; y < height * 3 / 4; ++y) {
    for (int x = width / 4; x < width * 3 / 4; ++x) *mask.at(x, y) = 255;
  }
  return mask;
}

// All axes parallel: every proxy plane is the scene's own plane, and the view is exact.
TEST(Reference, ReproducesAPlaneThroughS) {
  const test::World world = test::textured_plane(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  for (const bool distorted : {false, true}) {
    const geometry::Camera camera = make_camera(240, 180, distorted);
    const std::vector<Perspective> perspectives = parallel_row(world, camera, 15);
    const View view{make_camera(240, 180), {Eigen::Quaterniond::Identity(), {0.07, 0.05, -2.7}}};
    const hal::Image truth = test::photograph(world, view.camera, view.world_from_camera);
    for (const Aperture aperture : {Aperture::Small, Aperture::Wide}) {
      Settings settings;
      settings.aperture = aperture;
      const hal::Image mask = middle(240, 180);
      EXPECT_GT(psnr(render_reference(view, perspectives, settings), truth, &mask), 45.0);
    }
  }
}

TEST(Reference, AtARecordedViewShowsItsPicture) {
  const test::World world = test::textured_ball(1.0);
  const geometry::Camera camera = make_camera(160, 120);
  const auto perspectives = test::random_capture(world, camera, 8, 4.0, 0.4, 3);
  const View view{camera, perspectives[2].world_from_camera};
  const hal::Image mask = middle(160, 120);
  EXPECT_GT(psnr(render_reference(view, perspectives, {}), *perspectives[2].photo->rgb(), &mask),
            55.0);
}

// Refocusing: a plane off S is blurred by the wide aperture, and sharp when S is moved onto it.
TEST(Reference, WideApertureBlursWhatIsOffTheFocusPlane) {
  const test::World world = test::textured_plane(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  const geometry::Camera camera = make_camera(160, 120);
  const std::vector<Perspective> perspectives = parallel_row(world, camera, 15);
  const View view{camera, {Eigen::Quaterniond::Identity(), {0.0, 0.0, -3.0}}};
  const hal::Image truth = test::photograph(world, view.camera, view.world_from_camera);
  const hal::Image mask = middle(160, 120);
  Settings settings = augmented_settings_from({}, Eigen::Vector3d(0.0, 0.0, 0.0));
  const double in_focus = psnr(render_reference(view, perspectives, settings), truth, &mask);
  settings.focus.z() = -1.5;
  const double out_of_focus = psnr(render_reference(view, perspectives, settings), truth, &mask);
  EXPECT_GT(in_focus, 45.0);
  EXPECT_LT(out_of_focus, 25.0);
}

// The nearest one: what is next takes its place.
TEST(Reference, LeavesOutAPictureThatIsLost) {
  auto perspectives =
      test::random_capture(test::textured_ball(1.0), make_camera(32, 24), 4, 4.0, 0.3, 2);
  const View view{make_camera(32, 24), perspectives[1].world_from_camera};
  std::vector<Perspective> others = perspectives;
  others.erase(others.begin() + 1);
  Settings settings;
  settings.k = 2;
  const hal::Image without = render_reference(view, others, settings);
  EXPECT_NE(render_reference(view, perspectives, settings), without);
  perspectives[1].photo->stored_in("/nowhere/1.jpg");
  EXPECT_EQ(render_reference(view, perspectives, settings), without);
}

TEST(Reference, WhatNoPerspectiveCoversIsBlack) {
  const View view{make_camera(32, 24), look_at({0, 0, -4}, {0, 0, 0})};
  const hal::Image black(32, 24, 3);
  EXPECT_EQ(render_reference(view, {}, {}), black);
}

// With a view that moves by less than a thousandth of the distance nothing in the picture jumps,
// though perspectives enter and leave the k nearest.
TEST(Reference, WideAperturePicturesAreContinuous) {
  const auto perspectives =
      test::random_capture(test::textured_ball(1.0), make_camera(64, 48), 12, 4.0, 0.4, 5);
  Settings settings;
  settings.aperture = Aperture::Wide;
  settings.k = 4;
  hal::Image before;
  for (int step = 0; step < 120; ++step) {
    const View view{make_camera(64, 48), look_at({0.003 * step, 0.1, -4.0}, {0, 0, 0})};
    hal::Image after = render_reference(view, perspectives, settings);
    int largest = 0;
    for (std::size_t i = 0; i < before.size_bytes(); ++i) {
      largest = std::max(largest, std::abs(before.data()[i] - after.data()[i]));
    }
    EXPECT_LE(largest, 12) << "step " << step;
    before = std::move(after);
  }
}

}  // namespace
}  // namespace lumibox::render
