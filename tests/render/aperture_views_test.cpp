#include "render/aperture_views.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/rotation.h"
#include "render/ball_scene.h"

namespace lumibox::render {
namespace {

using Eigen::Vector3d;

/// The capture's centres and lenses; what they show is of no interest here.
std::vector<lightfield::Perspective> perspectives(int count) {
  return test::random_capture([](const test::Ray&) { return Vector3d::Zero().eval(); },
                              test::make_camera(8, 6), count, 4.0, 0.3, 5);
}

Settings wide(double exponent, int k) {
  Settings settings;
  settings.aperture = Aperture::Wide;
  settings.exponent = exponent;
  settings.k = k;
  return settings;
}

double angle_at_focus(const View& view, const View& other) {
  return geometry::angle_between(view.world_from_camera.translation,
                                 other.world_from_camera.translation);
}

TEST(ApertureViews, LieAsDenselyAsTheWeights) {
  for (const double exponent : {0.0, 0.5, 2.0, 20.0}) {
    constexpr int kSteps = 100000;
    const auto weight_within = [&](double radius) {
      double sum = 0.0;
      for (int i = 0; i < kSteps; ++i) {
        const double r = radius * (i + 0.5) / kSteps;
        sum += std::pow(1.0 - r, exponent) * r * radius / kSteps;
      }
      return sum;
    };
    for (const double share : {0.01, 0.3, 0.5, 0.9, 0.99}) {
      EXPECT_NEAR(weight_within(radius_of_share(share, exponent)) / weight_within(1.0), share, 1e-6)
          << exponent;
    }
  }
  EXPECT_NEAR(radius_of_share(0.5, -3.0), std::sqrt(0.5), 1e-9) << "as the weights have it";
}

TEST(ApertureViews, ReachAsFarAsThePerspectivesOnAllSides) {
  const View view = view_from({0.1, 0.2, -4.0});
  const auto all = perspectives(30);
  const Settings settings = wide(0.0, 12);
  const double limit = aperture_limit(view, all, settings);
  EXPECT_GT(limit, 0.05);
  const std::vector<View> views = aperture_views(view, all, settings);
  ASSERT_EQ(views.size(), 64U);
  Vector3d middle = Vector3d::Zero();
  double farthest = 0.0;
  for (const View& one : views) {
    middle += one.world_from_camera.translation / 64.0;
    farthest = std::max(farthest, angle_at_focus(view, one));
  }
  EXPECT_LT(farthest, limit);
  EXPECT_GT(farthest, 0.95 * limit);
  EXPECT_LT((middle - view.world_from_camera.translation).norm(), 0.03 * 4.0 * limit);
  const Vector3d axis = view.world_from_camera.rotation * Vector3d::UnitZ();
  for (const View& one : views) {
    EXPECT_NEAR(axis.dot(one.world_from_camera.translation - view.world_from_camera.translation),
                0.0, 1e-9);
  }
}

RC_GTEST_PROP(ApertureViewsProperties, LeaveThePlaneInFocusWhereItIs, ()) {
  const auto number = [](int low, int high) { return 0.01 * *rc::gen::inRange(low, high); };
  const View view = view_from({number(-200, 200), number(-200, 200), number(-500, -300)});
  Settings settings = wide(number(0, 500), *rc::gen::inRange(1, 40));
  settings.focus = Vector3d(number(-20, 20), number(-20, 20), number(-20, 20));
  const double depth = (view.world_from_camera.inverse() * settings.focus).z();
  const Vector3d in_view(depth * number(-50, 50), depth * number(-40, 40), depth);
  const Vector3d point = view.world_from_camera * in_view;
  const auto expected = view.camera.project(in_view);
  RC_ASSERT(expected.has_value());
  for (const View& one : aperture_views(view, perspectives(12), settings)) {
    const auto pixel = one.camera.project(one.world_from_camera.inverse() * point);
    RC_ASSERT(pixel.has_value());
    RC_ASSERT((*pixel - *expected).norm() < 1e-6);
  }
}

TEST(ApertureViews, WithLittleToGoByTheyStayFinite) {
  const View view = view_from({0.0, 0.0, -4.0});
  Settings settings = wide(2.0, 40);
  for (const int count : {0, 1, 3}) {  // also fewer than k
    for (const View& one : aperture_views(view, perspectives(count), settings)) {
      EXPECT_TRUE(one.world_from_camera.translation.allFinite()) << count;
      EXPECT_TRUE(std::isfinite(one.camera.profile().cx)) << count;
    }
  }
  settings.focus = {0.0, 0.0, -8.0};
  EXPECT_TRUE(aperture_views(view, perspectives(3), settings).empty()) << "behind the view";
  settings.focus = view.world_from_camera.translation;
  EXPECT_TRUE(aperture_views(view, perspectives(3), settings).empty()) << "in it";
  settings = wide(2.0, 40);
  settings.aperture_views = 0;
  EXPECT_TRUE(aperture_views(view, perspectives(3), settings).empty()) << "off";
}

}  // namespace
}  // namespace lumibox::render
