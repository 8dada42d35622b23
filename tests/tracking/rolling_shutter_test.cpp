#include "geometry/rolling_shutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/triangulation.h"
#include "tracking/pose_estimator.h"
#include "tracking/rolling_start.h"

namespace lumibox::tracking {
namespace {

constexpr double kReadoutS = 0.02;
constexpr double kPeriodS = 1.0 / 30.0;

geometry::Camera rolling_camera() {
  config::CameraProfile profile;
  profile.readout_s = kReadoutS;
  return geometry::Camera(profile);
}

/// A hand that walks sideways and trembles: twice a second about each axis, half a degree.
geometry::Pose camera_from_world(double time_s) {
  geometry::Vector6d twist;
  twist << -0.3 * time_s, 0.03 * std::sin(9.0 * time_s), 0.0, 0.009 * std::sin(13.0 * time_s),
      0.08 * time_s, 0.009 * std::sin(11.0 * time_s);
  return geometry::exp_se3(twist);
}

/// Pixel of a point by the true motion: the row and its time are found by bisection, so that
/// nothing here shares the code under test.
std::optional<Eigen::Vector2d> true_pixel(const geometry::Camera& camera, double time_s,
                                          const Eigen::Vector3d& point) {
  double low = -0.5;
  double high = 0.5;
  std::optional<Eigen::Vector2d> pixel;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    pixel = camera.project(camera_from_world(time_s + middle * kReadoutS) * point);
    if (!pixel) return std::nullopt;
    (pixel->y() / (camera.height() - 1) - 0.5 > middle ? low : high) = middle;
  }
  return pixel;
}

geometry::Vector6d true_twist(double time_s) {
  return geometry::log_se3(camera_from_world(time_s + 0.5 * kReadoutS) *
                           camera_from_world(time_s - 0.5 * kReadoutS).inverse());
}

std::vector<Eigen::Vector3d> points() {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Eigen::Vector3d> result;
  for (int i = 0; i < 150; ++i)
    result.emplace_back(0.9 * unit(random), 0.7 * unit(random), 2.0 + 0.6 * unit(random));
  return result;
}

TEST(RollingShutter, ProjectionFindsTheRowThatSeesThePoint) {
  const geometry::Camera camera = rolling_camera();
  const geometry::FramePose frame(camera_from_world(0.4), true_twist(0.4));
  for (const Eigen::Vector3d& point : points()) {
    const auto expected = true_pixel(camera, 0.4, point);
    const auto pixel = geometry::project(camera, frame, point);
    ASSERT_TRUE(expected && pixel);
    // 0.05 px: the true motion is not a constant twist; 1.5 rad/s^2 over half the readout are 0.04.
    EXPECT_LT((*pixel - *expected).norm(), 0.05);
  }
}

TEST(RollingShutter, AGlobalShutterIsUntouched) {
  const geometry::Camera camera;
  const geometry::FramePose frame(camera_from_world(0.4), true_twist(0.4));
  const Eigen::Vector3d point(0.2, -0.1, 2.0);
  EXPECT_EQ(*geometry::project(camera, frame, point),
            *camera.project(frame.camera_from_world * point));
  EXPECT_EQ(geometry::row_from_frame(camera, frame.readout_twist, 0.0).translation,
            Eigen::Vector3d::Zero());
}

TEST(RollingShutter, PoseIsThatOfTheMiddleRow) {
  const geometry::Camera camera = rolling_camera();
  std::vector<Measurement> seen;
  for (const Eigen::Vector3d& point : points()) {
    Measurement m;
    m.position = point;
    m.pixel = *true_pixel(camera, 0.4, point);
    seen.push_back(m);
  }
  const geometry::Pose truth = camera_from_world(0.4);
  const auto error = [&](const PoseEstimate& estimate) {
    return geometry::log_se3(estimate.pose.camera_from_world * truth.inverse()).norm();
  };
  const double with = error(estimate_pose(camera, seen, {truth, true_twist(0.4)}, 20));
  const double without = error(estimate_pose(camera, seen, truth, 20));
  // 5e-5: the mean over the rows of what the motion's curvature leaves, see above.
  EXPECT_LT(with, 5e-5);
  EXPECT_GT(without, 5e-4);
}

TEST(RollingShutter, TheFramesBetweenTakeTheShearOutOfAFirstMap) {
  const geometry::Camera camera = rolling_camera();
  constexpr int kFrames = 12;
  std::vector<std::int64_t> times_ns;
  for (int i = 0; i < kFrames; ++i) times_ns.push_back(std::llround(1e9 * i * kPeriodS));
  const geometry::Pose first = camera_from_world(0.0);
  InitialMap map;
  map.second_from_first = camera_from_world((kFrames - 1) * kPeriodS) * first.inverse();
  std::vector<PointPath> paths;
  std::vector<Eigen::Vector3d> truth;
  for (const Eigen::Vector3d& point : points()) {
    PointPath path;
    for (int i = 0; i < kFrames; ++i) path.push_back(*true_pixel(camera, i * kPeriodS, point));
    truth.push_back(first * point);
    // As two views make it that know nothing of rows.
    const auto sheared =
        geometry::triangulate(geometry::Pose(), map.second_from_first,
                              camera.unproject(path.front())->homogeneous().normalized(),
                              camera.unproject(path.back())->homogeneous().normalized());
    ASSERT_TRUE(sheared);
    map.points.push_back({*sheared, path.front(), path.back(), 0});
    paths.push_back(std::move(path));
  }
  const auto shape_error = [&] {
    Eigen::Matrix3Xd made(3, static_cast<Eigen::Index>(truth.size()));
    Eigen::Matrix3Xd wanted(3, made.cols());
    for (Eigen::Index i = 0; i < made.cols(); ++i) {
      made.col(i) = map.points[static_cast<std::size_t>(i)].position;
      wanted.col(i) = truth[static_cast<std::size_t>(i)];
    }
    const geometry::Similarity fit = geometry::align_umeyama(made, wanted);
    double squares = 0.0;
    for (Eigen::Index i = 0; i < made.cols(); ++i)
      squares += (fit * made.col(i) - wanted.col(i)).squaredNorm();
    return std::sqrt(squares / static_cast<double>(made.cols()));
  };
  const double before = shape_error();
  correct_for_readout(camera, times_ns, paths, map);
  // A quarter: how the motion changes at the two ends is known from one side only.
  EXPECT_LT(shape_error(), 0.25 * before) << before;
  EXPECT_LT((map.first_readout_twist - true_twist(0.0)).norm(), 0.2 * true_twist(0.0).norm());
  EXPECT_LT((map.second_readout_twist - true_twist((kFrames - 1) * kPeriodS)).norm(),
            0.2 * true_twist((kFrames - 1) * kPeriodS).norm());
}

}  // namespace
}  // namespace lumibox::tracking
