#include "app/track_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/moments.h"

namespace lumibox::app {
namespace {

using tracking::TrackingReason;
using tracking::TrackingState;

TEST(TrackReport, CountsFromTheFirstPoseAndNamesTheCauseOfEachLoss) {
  testing::World world;
  TrackReport report;
  double ms = 1.0;
  const auto add = [&](Moment moment) {
    moment.tracking_ms = ms++;
    report.add(moment);
  };
  for (int i = 0; i < 3; ++i) {
    add(world.see_nothing(TrackingReason::MoveSideways));
  }
  add(world.see_from({}));
  Moment poor = world.see_from({});
  poor.tracked.state = TrackingState::Poor;
  poor.tracked.reason = TrackingReason::TooDarkOrBlurred;
  add(poor);
  add(world.see_nothing(TrackingReason::Relocalising));
  add(world.see_nothing(TrackingReason::Relocalising));
  add(world.see_from({}));
  add(world.see_nothing(TrackingReason::TooFewPointsFound));
  add(world.see_from({}));

  const auto json = report.to_json({.keyframes = 4, .points = 99, .relocalisations = 2});
  EXPECT_EQ(json["frames"], 10);
  EXPECT_EQ(json["tracked"], 4);
  EXPECT_EQ(json["lost"], 3);
  EXPECT_EQ(json["initialised_at_frame"], 3);
  EXPECT_EQ(json["keyframes"], 4);
  EXPECT_EQ(json["points"], 99);
  EXPECT_EQ(json["relocalisations"], 2);
  EXPECT_EQ(json["loops_closed"], 0);
  EXPECT_EQ(json["ms"]["median"], 5.0);
  EXPECT_EQ(json["ms"]["p95"], 10.0);
  EXPECT_EQ(json["ms"]["max"], 10.0);
  ASSERT_EQ(json["losses"].size(), 2U);
  EXPECT_EQ(
      json["losses"][0],
      (nlohmann::json{{"reason", "too_dark_or_blurred"}, {"first_frame", 5}, {"last_frame", 6}}));
  EXPECT_EQ(
      json["losses"][1],
      (nlohmann::json{{"reason", "too_few_points_found"}, {"first_frame", 8}, {"last_frame", 8}}));
}

TEST(TrackReport, OfNothingIsStillWhole) {
  const auto json = TrackReport().to_json({});
  EXPECT_EQ(json["frames"], 0);
  EXPECT_TRUE(json["initialised_at_frame"].is_null());
  EXPECT_EQ(json["ms"]["median"], 0.0);
  EXPECT_TRUE(json["losses"].empty());
}

}  // namespace
}  // namespace lumibox::app
