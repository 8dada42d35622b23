#include "render/autofocus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/rotation.h"
#include "render/ball_scene.h"
#include "support/photo.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

constexpr double kDistance = 4.0;  // of the cameras from S

std::vector<Perspective> capture_of(const test::World& world) {
  return test::random_capture(world, test::make_camera(160, 120), 20, kDistance, 0.25, 11);
}

View straight_view() {
  return {test::make_camera(160, 120), test::look_at({0.0, 0.0, -kDistance}, kSubject)};
}

Settings wide() {
  Settings settings;
  settings.aperture = Aperture::Wide;
  settings.focus = kSubject;
  return settings;
}

/// Error in inverse depth, in steps of the sweep.
double error_in_steps(const std::optional<double>& depth, double truth) {
  return depth ? std::abs(kDistance / *depth - kDistance / truth) / kFocusStep
               : std::numeric_limits<double>::infinity();
}

/// Nothing to see.
test::World grey_world() {
  return [](const test::Ray&) -> Eigen::Vector3d { return Eigen::Vector3d::Constant(0.5); };
}

// Half a step: the parabola must do better than the sweep alone, whose best is within half. Of what
// is as near and as tilted as what is left out, the depth in the window changes by two steps.
TEST(Autofocus, FindsTexturedPlanesNearAndFarStraightAndTilted) {
  for (const double z : {-2.2, -1.3, -0.4, 0.0, 0.7, 2.0, 5.0}) {
    for (const double tilt : {0.0, 0.5, -0.9}) {
      if (z < -2.0 && tilt != 0.0) continue;
      const Eigen::Vector3d normal(std::sin(tilt), 0.0, std::cos(tilt));
      const auto perspectives = capture_of(test::textured_plane({0.0, 0.0, z}, normal));
      EXPECT_LT(error_in_steps(autofocus(straight_view(), perspectives, wide()), kDistance + z),
                0.5)
          << "z " << z << " tilt " << tilt;
    }
  }
}

TEST(Autofocus, WhatIsUnderTheReticleWins) {
  const auto perspectives = capture_of(test::textured_ball(1.0));
  EXPECT_LT(error_in_steps(autofocus(straight_view(), perspectives, wide()), 3.0), 0.5);
  View beside = straight_view();
  beside.world_from_camera.rotation =
      beside.world_from_camera.rotation * geometry::exp_so3({0.0, 0.33, 0.0});
  // The shell, at ten: beyond the ball's edge, which is seen at an angle of 0.25.
  const Eigen::Vector3d forward = beside.world_from_camera.rotation * Eigen::Vector3d::UnitZ();
  const double b = beside.world_from_camera.translation.dot(forward);
  const double shell = -b + std::sqrt(b * b - kDistance * kDistance + 100.0);
  // Its pattern is so coarse that half a step is a third of a pixel of a slow gradient.
  EXPECT_LT(error_in_steps(autofocus(beside, perspectives, wide()), shell), 1.0);
}

TEST(Autofocus, DoesNotMindUnequalExposures) {
  auto perspectives = capture_of(test::textured_plane(kSubject, Eigen::Vector3d::UnitZ()));
  for (std::size_t i = 0; i < perspectives.size(); i += 2) {
    hal::Image image = *perspectives[i].photo->rgb();
    for (std::size_t b = 0; b < image.size_bytes(); ++b) {
      image.data()[b] = static_cast<std::uint8_t>(0.8 * image.data()[b]);
    }
    perspectives[i].photo = testing::photo_of(std::move(image));
  }
  EXPECT_LT(error_in_steps(autofocus(straight_view(), perspectives, wide()), 4.0), 0.5);
}

TEST(Autofocus, WithoutTextureOrASecondPictureThereIsNone) {
  EXPECT_FALSE(autofocus(straight_view(), capture_of(grey_world()), wide()));
  auto noisy = capture_of(grey_world());
  std::uint32_t noise = 1;
  for (Perspective& perspective : noisy) {
    hal::Image image = *perspective.photo->rgb();
    for (std::size_t b = 0; b < image.size_bytes(); ++b) {
      noise = 1664525U * noise + 1013904223U;
      image.data()[b] = static_cast<std::uint8_t>(image.data()[b] + (noise >> 29));
    }
    perspective.photo = testing::photo_of(std::move(image));
  }
  EXPECT_FALSE(autofocus(straight_view(), noisy, wide())) << "noise is no texture";
  auto perspectives = capture_of(test::textured_ball(1.0));
  perspectives.resize(1);
  EXPECT_FALSE(autofocus(straight_view(), perspectives, wide()));
  EXPECT_FALSE(autofocus(straight_view(), {}, wide()));
}

TEST(Autofocus, HardViewsGiveNoneOrADepthBeforeTheView) {
  auto perspectives = capture_of(test::textured_ball(1.0));
  perspectives[3].photo = nullptr;
  perspectives[5].world_from_camera.translation = kSubject;
  Settings settings = wide();
  for (const Eigen::Vector3d& eye :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.0, 0.0, -1e-9),
        Eigen::Vector3d(0.0, 0.0, -1e9), Eigen::Vector3d(4.0, 0.0, 0.0)}) {
    for (const double turn : {0.0, 1.5, 3.1}) {
      View view = straight_view();
      view.world_from_camera.translation = eye;
      view.world_from_camera.rotation =
          view.world_from_camera.rotation * geometry::exp_so3({0.0, turn, 0.0});
      if (const auto depth = autofocus(view, perspectives, settings)) {
        EXPECT_TRUE(std::isfinite(*depth));
        EXPECT_GT(*depth, 0.0);
      }
    }
  }
  settings.focus = {0.0, 0.0, -9.0};
  EXPECT_FALSE(autofocus(straight_view(), perspectives, settings)) << "behind the view";
  settings.focus.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(autofocus(straight_view(), perspectives, settings));
}

}  // namespace
}  // namespace lumibox::render
