#include "render/proxy_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "geometry/rotation.h"
#include "lightfield/light_field.h"
#include "render/ball_scene.h"
#include "render/depth_grid.h"
#include "render/image_quality.h"
#include "render/reference.h"

namespace lumibox::render {
namespace {

using Eigen::Vector3d;
using lightfield::Perspective;

TEST(Closeness, FallsWithAngleAndDistance) {
  const Vector3d ray(0.1, 0.2, 1.0);
  double last = closeness(ray, ray);
  EXPECT_NEAR(last, std::pow(kLeastPenalty, -3.0), 1.0);
  for (const double angle : {0.01, 0.1, 1.0, 3.0}) {
    const double next = closeness(ray, geometry::exp_so3({0.0, angle, 0.0}) * ray);
    EXPECT_LT(next, last) << angle;
    last = next;
  }
  EXPECT_LT(closeness(ray, 2.0 * ray), closeness(ray, ray));
  EXPECT_EQ(closeness(ray, 0.5 * ray), closeness(ray, ray)) << "nearer is no worse";
}

TEST(Visibility, FallsSmoothlyWhereSomethingNearerIsSeen) {
  EXPECT_EQ(visibility(0.2, 0.25), 1.0) << "farther: it is seen through";
  EXPECT_EQ(visibility(0.25, 0.25), 1.0);
  EXPECT_NEAR(visibility(0.5, 0.25), kHidden, 1e-12);
  const double middle = 0.5 * (kBefore + kHiding);
  EXPECT_NEAR(visibility(0.25 * middle, 0.25), 0.5 * (1.0 + kHidden), 1e-12);
}

// Beside a pillar a picture taken from the left does not see what a view from the right sees of the
// wall: with its map it keeps the pillar to itself, without it paints the pillar onto the wall.
TEST(ProxyGeometry, WhatHidesTheWallIsNotPaintedOnIt) {
  const geometry::Camera camera = test::make_camera(160, 120);
  const test::World world = [](const test::Ray& ray) {
    const auto at = [&](double z) { return (z - ray.origin.z()) / ray.direction.z(); };
    const double x = (ray.origin + at(0.0) * ray.direction).x();
    return std::abs(x) < 0.15 ? Vector3d(1.0, 0.0, 0.0) : Vector3d(0.0, 0.0, 1.0);
  };
  const auto taken_from = [&](int id, double x) {
    return test::photograph_perspective(id, world, camera,
                                        {Eigen::Quaterniond::Identity(), Vector3d(x, 0.0, -2.0)});
  };
  const auto depths_from = [&](double x) {  // pillar at 2, wall at 4
    std::vector<float> inverse_depths;
    for (int v = 0; v < 120; ++v) {
      for (int u = 0; u < 160; ++u) {
        const bool pillar = std::abs(x + 2.0 * ray_at(camera, u, v).x()) < 0.15;
        inverse_depths.push_back(pillar ? 0.5F : 0.25F);
      }
    }
    return std::make_shared<DepthMap>(camera, inverse_depths,
                                      std::vector<float>(inverse_depths.size(), 1.0F));
  };
  const std::vector<Perspective> both{taken_from(0, 0.5), taken_from(1, -0.6)};
  const View view{camera, {Eigen::Quaterniond::Identity(), Vector3d(0.0, 0.0, -2.0)}};
  Settings settings;
  settings.focus = Vector3d(0.0, 0.0, 2.0);
  const DepthGrid grid(view, {{depths_from(0.0), view.world_from_camera, 1.0}}, 0.25);
  const auto red_on_the_wall = [&](const Shape& shape) {
    settings.shape = std::make_shared<Shape>(shape);
    const hal::Image picture = render_reference(view, both, settings);
    int most = 0;
    for (int u = 20; u < 140; ++u) {
      if (std::abs(u - 79.5) > 20.0) most = std::max<int>(most, picture.at(u, 60)[0]);
    }
    return most;
  };
  EXPECT_GT(red_on_the_wall({grid, {}}), 60);
  EXPECT_LT(red_on_the_wall({grid, {depths_from(0.5), depths_from(-0.6)}}), 12);
}

TEST(ProxyGeometry, FocalPlaneLiesAtTheHarmonicMean) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 40; ++i) points.emplace_back(0.01 * i, 0.0, i % 2 == 0 ? -2.0 : 4.0);
  Settings settings;
  settings.focus = kSubject;
  const View view = view_from({0.0, 0.0, -4.0});
  const Settings fit =
      ProxyGeometry(points, Estimating::AtOnce).fit(settings, Geometry::Focal, view, {});
  EXPECT_LT((fit.focus - Vector3d(0.0, 0.0, -4.0 + 2.0 / (1.0 / 2.0 + 1.0 / 8.0))).norm(), 1e-9);
  points.resize(5);
  EXPECT_EQ(
      ProxyGeometry(points, Estimating::AtOnce).fit(settings, Geometry::Focal, view, {}).focus,
      kSubject);
  EXPECT_EQ(
      ProxyGeometry(points, Estimating::AtOnce).fit(settings, Geometry::Plane, view, {}).shape,
      nullptr);
}

// Beside the ball's silhouette and before the far shell planes are wrong, the shape is not.
TEST(ProxyGeometry, AShapeIsLikerThanPlanes) {
  const auto perspectives = around_a_ball(test::make_camera(192, 144), 12);
  const View view{test::make_camera(192, 144), test::look_at({0.2, 0.15, -3.9}, kSubject)};
  const hal::Image truth =
      test::photograph(test::textured_ball(1.0), view.camera, view.world_from_camera);
  ProxyGeometry proxy({}, Estimating::AtOnce);
  Settings settings;
  settings.focus = kSubject;
  const double plane = psnr(render_reference(view, perspectives, settings), truth);
  const double mesh = psnr(
      render_reference(view, perspectives, proxy.fit(settings, Geometry::Mesh, view, perspectives)),
      truth);
  EXPECT_GT(mesh, plane + 4.0) << plane << " dB with planes";
}

// Where the sets of maps and of pictures change, too. At edges, whose depths are uncertain, a
// picture may slide quickly (74 grey levels in 0.01 degrees, at one pixel of a small picture), but
// a tenth of the step is a tenth of the change: nothing jumps.
TEST(ProxyGeometry, NothingPopsAsTheViewMoves) {
  const auto perspectives = around_a_ball(test::make_camera(96, 72), 12);
  ProxyGeometry proxy({}, Estimating::AtOnce);
  Settings settings;
  settings.focus = kSubject;
  settings.k = 4;
  const auto picture = [&](double angle) {
    const View view = view_from({4.0 * std::sin(angle), 0.3, -4.0 * std::cos(angle)});
    return render_reference(view, perspectives,
                            proxy.fit(settings, Geometry::Mesh, view, perspectives));
  };
  const auto largest_change = [&](double from, double to) {
    const hal::Image before = picture(from);
    const hal::Image after = picture(to);
    int largest = 0;
    for (std::size_t i = 0; i < before.size_bytes(); ++i) {
      largest = std::max(largest, std::abs(before.data()[i] - after.data()[i]));
    }
    return largest;
  };
  for (int i = 0; i < 60; ++i) {
    const double angle = -0.2 + 0.006 * i;
    const double step = 0.01 * std::numbers::pi / 180.0;
    EXPECT_LE(largest_change(angle, angle + step), 85) << angle;
    EXPECT_LE(largest_change(angle, angle + 0.1 * step), 12) << angle;
  }
  // Exactly where one perspective takes the place of another among the four nearest.
  const auto nearest_four = [&](double angle) {
    const Vector3d center(4.0 * std::sin(angle), 0.3, -4.0 * std::cos(angle));
    std::vector<std::pair<double, int>> ranked;
    for (const Perspective& p : perspectives) {
      ranked.emplace_back(lightfield::angle_at_subject(center, kSubject, p.center()), p.id);
    }
    std::sort(ranked.begin(), ranked.end());
    std::set<int> ids;
    for (int i = 0; i < 4; ++i) ids.insert(ranked[static_cast<std::size_t>(i)].second);
    return ids;
  };
  int changes = 0;
  for (double low = -0.2; low < 0.2; low += 0.01) {
    double before = low;
    double after = low + 0.01;
    if (nearest_four(before) == nearest_four(after)) continue;
    while (after - before > 1e-7) {
      const double middle = 0.5 * (before + after);
      (nearest_four(middle) == nearest_four(before) ? before : after) = middle;
    }
    EXPECT_LE(largest_change(before, after), 1) << before;
    ++changes;
  }
  EXPECT_GE(changes, 2);
}

TEST(ProxyGeometry, HardViewsStayFinite) {
  auto perspectives = around_a_ball(test::make_camera(48, 36), 6);
  perspectives.push_back(perspectives[2]);  // two at one centre
  ProxyGeometry proxy({}, Estimating::AtOnce);
  Settings settings;
  settings.focus = kSubject;
  const Vector3d recorded = perspectives[1].center();
  const std::vector<geometry::Pose> poses{
      perspectives[1].world_from_camera,
      test::look_at(-recorded, kSubject),                   // the far side
      test::look_at({0.0, 0.0, -0.5}, {0.0, 0.0, 5.0}),     // inside the ball
      test::look_at(recorded, 2.0 * recorded),              // looking away
      test::look_at({0.0, -4.0, 1e-9}, kSubject),           // above the pole
      test::look_at(recorded, kSubject, std::numbers::pi),  // upside down
      test::look_at(kSubject, {0.0, 0.0, 1.0}),             // at S
  };
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const View view{test::make_camera(48, 36), poses[i]};
    const Settings fit = proxy.fit(settings, Geometry::Mesh, view, perspectives);
    for (const float rho : fit.shape->grid.inverse_depths()) {
      ASSERT_TRUE(std::isfinite(rho) && rho >= 0.0F) << "view " << i;
    }
    render_reference(view, perspectives, fit);
  }
  perspectives[4].world_from_camera.translation = kSubject;
  const Settings at_subject =
      proxy.fit(settings, Geometry::Mesh,
                {test::make_camera(48, 36), perspectives[4].world_from_camera}, perspectives);
  for (const float rho : at_subject.shape->grid.inverse_depths()) ASSERT_TRUE(std::isfinite(rho));
  for (const auto& map : at_subject.shape->maps) {
    for (std::size_t i = 0; map && i < map->size(); ++i) {
      ASSERT_TRUE(std::isfinite(map->inverse_depth(i)));
    }
  }
  const View view = view_from({0.0, 0.0, -4.0});
  EXPECT_EQ(render_reference(view, {}, proxy.fit(settings, Geometry::Mesh, view, {})),
            hal::Image(96, 72, 3));
  const std::vector<Perspective> one{perspectives[0]};
  render_reference(view, one, proxy.fit(settings, Geometry::Mesh, view, one));
}

}  // namespace
}  // namespace lumibox::render
