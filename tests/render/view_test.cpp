#include "render/view.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "render/ray_cast.h"
#include "support/photo.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;
using test::look_at;
using test::make_camera;

constexpr double kPi = std::numbers::pi;

/// A perspective whose picture does not matter.
Perspective blank(int id, const geometry::Pose& pose) {
  Perspective p;
  p.id = id;
  p.world_from_camera = pose;
  p.photo = testing::photo_of(hal::Image(64, 48, 3));
  p.camera = std::make_shared<const geometry::Camera>(make_camera(64, 48));
  return p;
}

/// Centre at distance 4 from the origin, `across` and `up` radians from -z, looking at the origin.
geometry::Pose on_orbit(double across, double up = 0.0) {
  const Eigen::Vector3d center(4.0 * std::sin(across) * std::cos(up), 4.0 * std::sin(up),
                               -4.0 * std::cos(across) * std::cos(up));
  return look_at(center, Eigen::Vector3d::Zero());
}

View view_at(const geometry::Pose& pose) {
  return {make_camera(64, 48), pose};
}

std::vector<Perspective> arc(int count, double step) {
  std::vector<Perspective> perspectives;
  for (int i = 0; i < count; ++i) perspectives.push_back(blank(i, on_orbit(step * i)));
  return perspectives;
}

TEST(PlanView, TakesTheNearestByAngleAtS) {
  Settings settings;
  settings.k = 3;
  const auto layers = plan_view(view_at(on_orbit(0.52)), arc(10, 0.1), settings);
  ASSERT_EQ(layers.size(), 3U);
  EXPECT_EQ(layers[0].perspective, 5U);
  EXPECT_EQ(layers[1].perspective, 6U);
  EXPECT_EQ(layers[2].perspective, 4U);
  EXPECT_NEAR(layers[0].penalty, 0.02, 1e-9);
}

// The penalty is an angle at S: how far away a centre is does not count.
TEST(PlanView, DistanceFromSDoesNotCount) {
  const Eigen::Vector3d direction(0.0, 0.0, -1.0);
  std::vector<Perspective> perspectives = {
      blank(0, on_orbit(0.1)), blank(1, look_at(40.0 * direction, Eigen::Vector3d::Zero()))};
  EXPECT_EQ(plan_view(view_at(on_orbit(0.0)), perspectives, {})[0].perspective, 1U);
}

TEST(PlanView, NormalTurnsFromTheViewsAxisToThePerspectivesOwn) {
  for (const double angle : {0.0, 0.3, 1.0, 1.5}) {
    const auto layers = plan_view(view_at(on_orbit(0.0)), {blank(0, on_orbit(angle))}, {});
    ASSERT_EQ(layers.size(), 1U);
    const Eigen::Vector3d view_axis = on_orbit(0.0).rotation * Eigen::Vector3d::UnitZ();
    const double turned = geometry::angle_between(view_axis, layers[0].normal);
    EXPECT_NEAR(turned, angle * angle / (0.5 * kPi), 1e-9);
  }
}

TEST(PlanView, BeyondNinetyDegreesTheNormalIsThePerspectivesOwn) {
  const geometry::Pose source = on_orbit(2.0);
  const auto layers = plan_view(view_at(on_orbit(0.0)), {blank(0, source)}, {});
  ASSERT_EQ(layers.size(), 1U);
  EXPECT_LT((layers[0].normal - source.rotation * Eigen::Vector3d::UnitZ()).norm(), 1e-9);
}

RC_GTEST_PROP(PlanView, HomographyIsRayThroughPlane, ()) {
  const auto radians = [] { return *rc::gen::inRange(-1000, 1000) * 1e-3; };
  const View view = view_at(on_orbit(radians(), radians()));
  const std::vector<Perspective> perspectives = {blank(0, on_orbit(radians(), radians()))};
  Settings settings;
  settings.focus = Eigen::Vector3d(0.3 * radians(), 0.3 * radians(), 0.3 * radians());
  const auto layers = plan_view(view, perspectives, settings);
  RC_PRE(!layers.empty());
  const Layer& layer = layers[0];

  const Eigen::Vector3d pixel(*rc::gen::inRange(0, 64), *rc::gen::inRange(0, 48), 1.0);
  const Eigen::Vector3d ray =
      view.world_from_camera.rotation * view.camera.unproject(pixel.head<2>())->homogeneous();
  const Eigen::Vector3d& eye = view.world_from_camera.translation;
  const double t = layer.normal.dot(settings.focus - eye) / layer.normal.dot(ray);
  RC_PRE(std::abs(t) < 1e3);
  const Eigen::Vector3d in_source = perspectives[0].world_from_camera.inverse() * (eye + t * ray);
  const Eigen::Vector3d mapped = layer.source_from_pixel * pixel;
  RC_ASSERT((t > 0.0) == (layer.before_view.dot(pixel) > 0.0));
  RC_ASSERT((mapped - in_source / t).norm() < 1e-6 * (1.0 + mapped.norm()));
}

RC_GTEST_PROP(PlanView, WideWeightsSumToOne, ()) {
  Settings settings;
  settings.aperture = Aperture::Wide;
  settings.k = *rc::gen::inRange(1, 30);
  settings.exponent = 0.5 * *rc::gen::inRange(0, 8);
  const double across = *rc::gen::inRange(-1000, 1000) * 1e-3;
  double sum = 0.0;
  for (const Layer& layer : plan_view(view_at(on_orbit(across)), arc(20, 0.03), settings)) {
    sum += layer.weight;
  }
  RC_ASSERT(std::abs(sum - 1.0) < 1e-9);
}

// As the view moves, perspectives enter and leave the k nearest; no weight may jump.
TEST(PlanView, WideWeightsAreContinuousWhereMembershipChanges) {
  Settings settings;
  settings.aperture = Aperture::Wide;
  settings.k = 5;
  const std::vector<Perspective> perspectives = arc(20, 0.05);
  const auto weights_at = [&](double across) {
    std::vector<double> weights(perspectives.size(), 0.0);
    for (const Layer& layer : plan_view(view_at(on_orbit(across, 0.1)), perspectives, settings)) {
      weights[layer.perspective] = layer.weight;
    }
    return weights;
  };
  std::vector<double> before = weights_at(0.2);
  for (int step = 1; step <= 1000; ++step) {
    const std::vector<double> after = weights_at(0.2 + 0.0005 * step);
    for (std::size_t i = 0; i < after.size(); ++i) EXPECT_NEAR(after[i], before[i], 0.02);
    before = after;
  }
}

TEST(PlanView, OrderDoesNotDependOnTheOrderOfTheSet) {
  std::vector<Perspective> forward = arc(9, 0.1);
  std::vector<Perspective> backward(forward.rbegin(), forward.rend());
  const View middle = view_at(on_orbit(0.4));  // ties on both sides
  const auto a = plan_view(middle, forward, {});
  const auto b = plan_view(middle, backward, {});
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(forward[a[i].perspective].id, backward[b[i].perspective].id);
  }
}

struct HardCase {
  std::string name;
  View view;
  std::vector<Perspective> perspectives;
  Settings settings;
};

std::vector<HardCase> hard_cases() {
  const auto set = [](int k, const Eigen::Vector3d& focus) {
    Settings settings;
    settings.k = k;
    settings.focus = focus;
    return settings;
  };
  const Eigen::Vector3d s = Eigen::Vector3d::Zero();
  const View front = view_at(on_orbit(0.0));
  std::vector<Perspective> twins = {blank(0, on_orbit(0.1)), blank(1, on_orbit(0.1))};
  Perspective no_picture = blank(0, on_orbit(0.1));
  no_picture.photo.reset();
  Perspective nowhere = blank(0, on_orbit(0.1));
  nowhere.world_from_camera.translation.x() = std::nan("");
  return {
      {"k larger than the set", front, arc(3, 0.1), set(40, s)},
      {"k of zero", front, arc(3, 0.1), set(0, s)},
      {"negative k", front, arc(3, 0.1), set(-7, s)},
      {"huge k", front, arc(200, 0.01), set(1000, s)},
      {"empty set", front, {}, set(40, s)},
      {"one perspective", front, arc(1, 0.1), set(40, s)},
      {"two at the same centre", front, twins, set(40, s)},
      {"two at the same centre as the view", view_at(on_orbit(0.1)), twins, set(1, s)},
      {"view at a recorded view", view_at(on_orbit(0.1)), arc(3, 0.1), set(2, s)},
      {"plane edge-on",
       view_at(look_at({0, 0, -4}, {4, 0, -4})),
       {blank(0, look_at({-4, 0, 0}, {0, 0, 0}))},
       set(40, s)},
      {"S behind a camera", front, {blank(0, look_at({0, 0, -4}, {0, 0, -8}))}, set(40, s)},
      {"S behind the view", view_at(look_at({0, 0, -4}, {0, 0, -8})), arc(3, 0.1), set(40, s)},
      {"view at S", view_at(look_at({0, 0, 0}, {0, 0, 1})), arc(3, 0.1), set(40, s)},
      {"a camera at S", front, {blank(0, look_at({0, 0, 0}, {0, 0, 1}))}, set(40, s)},
      {"view beyond S", view_at(look_at({0, 0, 3}, {0, 0, 9})), arc(3, 0.1), set(40, s)},
      {"opposite view", view_at(on_orbit(kPi)), arc(3, 0.1), set(40, s)},
      {"rolled by 180 degrees", view_at(look_at({0, 0, -4}, s, kPi)), arc(3, 0.1), set(40, s)},
      {"no picture", front, {no_picture}, set(40, s)},
      {"a pose that is no number", front, {nowhere}, set(40, s)},
      {"S that is no number", front, arc(3, 0.1), set(40, {std::nan(""), 0, 0})},
  };
}

TEST(PlanView, HardCasesGiveFiniteLayers) {
  for (const HardCase& hard : hard_cases()) {
    for (const Aperture aperture : {Aperture::Small, Aperture::Wide}) {
      for (const double exponent : {0.0, 2.0, 50.0}) {
        Settings settings = hard.settings;
        settings.aperture = aperture;
        settings.exponent = exponent;
        const auto layers = plan_view(hard.view, hard.perspectives, settings);
        EXPECT_LE(layers.size(), kMaxLayers);
        for (const Layer& layer : layers) {
          EXPECT_TRUE(layer.source_from_pixel.allFinite()) << hard.name;
          EXPECT_TRUE(layer.before_view.allFinite()) << hard.name;
          EXPECT_TRUE(std::isfinite(layer.penalty)) << hard.name;
          EXPECT_TRUE(layer.weight >= 0.0 && layer.weight <= 1.0) << hard.name;
        }
      }
    }
  }
}

TEST(PlanView, LeavesOutWhatCannotBeSeen) {
  for (const HardCase& hard : hard_cases()) {
    const std::size_t layers = plan_view(hard.view, hard.perspectives, hard.settings).size();
    if (hard.name == "huge k") {
      EXPECT_EQ(layers, kMaxLayers);
    }
    if (hard.name == "k larger than the set") {
      EXPECT_EQ(layers, 3U);
    }
    for (const char* nothing :
         {"plane edge-on", "S behind a camera", "S behind the view", "view at S", "a camera at S",
          "no picture", "empty set", "a pose that is no number", "S that is no number"}) {
      if (hard.name == nothing) {
        EXPECT_EQ(layers, 0U) << hard.name;
      }
    }
  }
}

}  // namespace
}  // namespace lumibox::render
