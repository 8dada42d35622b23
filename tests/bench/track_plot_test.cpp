#include "bench/track_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bench/map_views.h"

namespace lumibox::bench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using tracking::TrackingReason;
using tracking::TrackingState;

/// Held level at `place`, z of the world being up; `down` is how far it looks below the horizon.
geometry::Pose level_camera(const Eigen::Vector3d& place, double azimuth, double down) {
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(azimuth, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(-0.5 * std::numbers::pi - down, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return {turn, place};
}

/// Ten seconds around a subject; lost from 4 s to 6 s.
TrackPlot walk() {
  TrackPlot plot;
  plot.title = "walk <1>";
  plot.figures = {"100 frames", "an error"};
  for (int i = 0; i < 100; ++i) {
    const double t = 0.1 * i;
    const bool lost = i >= 40 && i < 60;
    plot.frames.push_back({t, lost ? TrackingState::Lost : TrackingState::Good,
                           lost ? TrackingReason::Relocalising : TrackingReason::None,
                           lost ? 0 : 400, 4.0});
    if (lost) continue;
    const geometry::Pose pose = level_camera({std::cos(t), std::sin(t), 0.1 * t}, t, 0.3);
    plot.live.push_back({t, pose});
    plot.corrected.push_back({t, pose});
  }
  plot.points = {{0, 0, 0}, {0.1, 0.2, 0.3}};
  plot.keyframes = {plot.live.front().world_from_camera};
  return plot;
}

TEST(TrackPlot, SaysWhatItShowsAndInWhichUnits) {
  const std::string text = draw_track(walk()).str();
  EXPECT_THAT(
      text, AllOf(HasSubstr(">walk &lt;1&gt;<"), HasSubstr(">100 frames<"), HasSubstr(">an error<"),
                  HasSubstr(">Top view<"), HasSubstr("right [median depths at the start]")));
  EXPECT_THAT(text, AllOf(HasSubstr(">Map points found<"), HasSubstr("[ms]"),
                          HasSubstr("time since the first frame [s]"),
                          HasSubstr("lost: return to a place seen before")));
  EXPECT_THAT(text, AllOf(Not(HasSubstr("Error of the position")), Not(HasSubstr(">truth<")),
                          Not(HasSubstr(">perspective<"))));
  EXPECT_THAT(text, AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf\""))));
}

TEST(TrackPlot, WithATruthItShowsErrorsInTheTruthsUnits) {
  TrackPlot plot = walk();
  plot.truth = plot.corrected;
  for (hal::StampedPose& pose : plot.truth) {
    pose.world_from_camera.translation *= 50.0;
    pose.world_from_camera.translation.z() += 0.1 * std::sin(9.0 * pose.timestamp_s);
  }
  plot.perspectives = {{1, 0, 0}};
  const std::string text = draw_track(plot).str();
  EXPECT_THAT(text, AllOf(HasSubstr("Error of the position"), HasSubstr("[units of the truth]"),
                          HasSubstr(">truth<"), HasSubstr(">perspective<"), HasSubstr(">40<")));
}

TEST(TrackPlot, LossIsMarkedOnTheMap) {
  TrackPlot plot = walk();
  const auto dashes = [](const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find("stroke-dasharray", at)) != std::string::npos; ++at) {
      ++count;
    }
    return count;
  };
  EXPECT_EQ(dashes(draw_track(plot).str()), 3U);  // in the legend and in two views
  // The same poses, but nobody looked between them.
  std::erase_if(plot.frames,
                [](const PlottedFrame& frame) { return frame.state == TrackingState::Lost; });
  EXPECT_EQ(dashes(draw_track(plot).str()), 1U);
}

TEST(TrackPlot, OfARecordingThatWasNeverTrackedIsStillAPage) {
  TrackPlot plot;
  plot.frames = {{1.0, TrackingState::Initialising, TrackingReason::MoveSideways, 0, 3.0}};
  plot.truth = walk().live;
  const std::string text = draw_track(plot).str();
  EXPECT_THAT(text,
              AllOf(HasSubstr(">Top view<"), Not(HasSubstr("nan")), Not(HasSubstr(">truth<"))));
}

TEST(TrackPlot, UpIsWhereALevelHandHasIt) {
  const Eigen::Quaterniond world_turn = geometry::exp_so3({0.7, -1.1, 0.4});
  std::vector<hal::StampedPose> orbit;
  for (int i = 0; i < 30; ++i) {  // two thirds of an orbit, looking down steeply
    geometry::Pose pose = level_camera({}, 0.14 * i, 0.9);
    pose.rotation = world_turn * pose.rotation;
    orbit.push_back({0.1 * i, pose});
  }
  const Eigen::Matrix3d map = map_from_world(orbit);
  EXPECT_TRUE((map * map.transpose()).isIdentity(1e-9));
  EXPECT_NEAR(map.determinant(), 1.0, 1e-9);
  const Eigen::Vector3d up = map * (world_turn * Eigen::Vector3d::UnitZ());
  EXPECT_GT(up.z(), 0.99);
  // The first camera looks ahead.
  EXPECT_GT((map * orbit.front().world_from_camera.matrix3().col(2)).y(), 0.5);
}

TEST(TrackPlot, UpIsTheMeanOfTheCamerasOwnIfTheyRoll) {
  std::vector<hal::StampedPose> trajectory;
  for (int i = -10; i <= 10; ++i) {
    geometry::Pose pose = level_camera({}, 0.0, 0.2);
    pose.rotation = pose.rotation * geometry::exp_so3({0.0, 0.0, 0.06 * i});
    trajectory.push_back({0.1 * i, pose});
  }
  EXPECT_GT(map_from_world(trajectory)(2, 2), 0.95);
}

}  // namespace
}  // namespace lumibox::bench
