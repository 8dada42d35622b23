#include "lightfield/track_triangulation.h"

#include <gtest/gtest.h>

#include "lightfield/lonely_points.h"
#include "support/pinhole.h"

namespace lumibox::lightfield {
namespace {

const geometry::Camera kCamera = testing::pinhole(640, 480, 500.0);

/// Cameras side by side that look along z, 0.1 apart.
std::vector<View> row_of_views(int count) {
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    views.push_back({{Eigen::Quaterniond::Identity(), {-0.1 * i, 0.0, 0.0}}, &kCamera, 1.5});
  }
  return views;
}

Observation observe(const std::vector<View>& views, std::size_t view, const Eigen::Vector3d& point,
                    const Eigen::Vector2d& error = Eigen::Vector2d::Zero()) {
  const Eigen::Vector2d pixel =
      kCamera.project(views[view].camera_from_world * point).value() + error;
  return {view, pixel, kCamera.unproject(pixel).value().homogeneous().normalized()};
}

TEST(TrackTriangulation, UsesAllViews) {
  const auto views = row_of_views(6);
  const Eigen::Vector3d point(0.2, 0.1, 2.0);
  std::vector<Observation> track;
  for (std::size_t v = 0; v < 6; ++v) {
    // Errors that no straight line through the views explains: they cancel out.
    const double sign = v == 0 || v == 3 || v == 4 ? 1.0 : -1.0;
    track.push_back(observe(views, v, point, {0.0, 0.5 * sign}));
  }
  const auto points = triangulate_track(views, track);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(points[0].views.size(), 6U);
  EXPECT_LT((points[0].position - point).norm(), 1e-4);
}

TEST(TrackTriangulation, SeparatesWhatMatchesHaveJoined) {
  const auto views = row_of_views(5);
  const Eigen::Vector3d a(0.2, 0.1, 2.0);
  const Eigen::Vector3d b(0.0, -0.3, 3.0);
  std::vector<Observation> track;
  for (std::size_t v = 0; v < 5; ++v) track.push_back(observe(views, v, a));
  for (std::size_t v = 1; v < 4; ++v) track.push_back(observe(views, v, b));
  track.push_back(observe(views, 0, {0.4, 0.4, 5.0}));  // of nothing else
  const auto points = triangulate_track(views, track);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_LT((points[0].position - a).norm(), 1e-6);
  EXPECT_EQ(points[0].views, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_LT((points[1].position - b).norm(), 1e-6);
  EXPECT_EQ(points[1].views, (std::vector<std::size_t>{1, 2, 3}));
}

TEST(TrackTriangulation, GivesNothingThatIsNotSure) {
  const auto views = row_of_views(3);
  const auto track = [&](const Eigen::Vector3d& point, std::size_t count) {
    std::vector<Observation> seen;
    for (std::size_t v = 0; v < count; ++v) seen.push_back(observe(views, v, point));
    return seen;
  };
  EXPECT_EQ(triangulate_track(views, track({0.1, 0.0, 2.0}, 3)).size(), 1U);
  EXPECT_TRUE(triangulate_track(views, track({0.1, 0.0, 2.0}, 2)).empty());   // two views
  EXPECT_TRUE(triangulate_track(views, track({0.1, 0.0, 12.0}, 3)).empty());  // little parallax
  EXPECT_TRUE(triangulate_track(views, track({0.1, 0.0, 1e9}, 3)).empty());   // none
  auto apart = track({0.1, 0.0, 2.0}, 3);
  apart[1] = observe(views, 1, {0.1, 0.0, 2.0}, {0.0, 5.0});
  EXPECT_TRUE(triangulate_track(views, apart).empty());
}

TEST(LonelyPoints, GoUnlessManyViewsHaveSeenThem) {
  const auto views = row_of_views(6);
  const std::vector<std::size_t> few{0, 1, 2};
  const std::vector<std::size_t> all{0, 1, 2, 3, 4, 5};
  std::vector<TrackPoint> points;
  for (int i = 0; i < 25; ++i) {
    points.push_back({{0.1 * (i % 5), 0.1 * (i / 5), 3.0 + 0.002 * i}, few});
  }
  points.push_back({{0.13, 0.12, 2.0}, few});
  points.push_back({{0.14, 0.22, 2.0}, all});
  const auto kept = without_lonely_points(views, points);
  ASSERT_EQ(kept.size(), 26U);
  for (std::size_t i = 0; i < 25; ++i) EXPECT_EQ(kept[i].position, points[i].position);
  EXPECT_EQ(kept[25].position, points[26].position);
}

}  // namespace
}  // namespace lumibox::lightfield
