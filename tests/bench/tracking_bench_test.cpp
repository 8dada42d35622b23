#include "bench/tracking_bench.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "hal/replay/replay_camera.h"
#include "hal/sim/random_scene.h"
#include "hal/sim/virtual_clock.h"
#include "support/recording.h"

namespace lumibox::bench {
namespace {

/// Pictures too small and too plain to be tracked.
Footage plain_footage() {
  const testing::Recording recording;
  const hal::Sequence sequence = hal::open_sequence(recording.folder());
  hal::VirtualClock clock;
  hal::ReplayCamera camera(sequence, clock, hal::Pacing::Lockstep);
  camera.start();
  Footage footage = film("plain", camera, clock, 100);
  footage.truth = sequence.ground_truth;
  return footage;
}

TEST(Footage, HoldsThePicturesOfTheRecordingWithTheirTimes) {
  const Footage footage = plain_footage();
  ASSERT_EQ(footage.frames.size(), 5U);
  EXPECT_EQ(footage.frames[1].timestamp_ns - footage.frames[0].timestamp_ns, 100'000'000);
  EXPECT_EQ(*footage.frames[3].gray, hal::to_gray(testing::Recording::picture(3)));
  const testing::Recording recording;
  hal::VirtualClock clock;
  hal::ReplayCamera camera(hal::open_sequence(recording.folder()), clock, hal::Pacing::Lockstep);
  camera.start();
  EXPECT_EQ(film("plain", camera, clock, 2).frames.size(), 2U);
}

TEST(Footage, HalvedIsWhatACameraOfHalfTheSizeSees) {
  const Footage half = halved(plain_footage());
  EXPECT_EQ(half.camera.width(), 16);
  EXPECT_EQ(half.frames[0].gray->width(), 16);
  EXPECT_EQ(half.frames.size(), 5U);
  EXPECT_EQ(half.truth.size(), 5U);
}

TEST(Footage, OfASceneKnowsWhereEachPictureWasTaken) {
  hal::sim::SceneSpec spec =
      hal::sim::random_scene({3, hal::sim::Place::Can, hal::sim::Walk::Arc, {}});
  spec.camera = geometry::Camera(spec.camera).at_level(3).profile();
  const auto scene = hal::make_scene(spec);
  const Footage footage = film_scene("can", scene, 4);
  ASSERT_EQ(footage.frames.size(), 4U);
  ASSERT_EQ(footage.truth.size(), 4U);
  EXPECT_EQ(footage.frames[3].gray->width(), 80);
  for (std::size_t i = 0; i < 4; ++i) {
    const double time_s = 1e-9 * static_cast<double>(footage.frames[i].timestamp_ns);
    EXPECT_EQ(footage.truth[i].timestamp_s, time_s);
    EXPECT_EQ(footage.truth[i].world_from_camera.translation,
              scene->world_from_camera(time_s).translation);
  }
}

TEST(TrackingVariations, DifferInOneSettingAndHoldTheDefaultOnce) {
  config::Tracking options;
  options.max_measurements = 333;  // none of the values tried
  options.pyramid_levels = 3;      // one of them
  const auto variations = tracking_variations(options, 640);
  std::map<std::string, int> defaults;
  for (const Variation& v : variations) {
    if (v.is_default) ++defaults[v.setting];
    const config::Tracking& o = v.options;
    const int differences = (o.max_measurements != 333) + (o.max_features_per_keyframe != 1200) +
                            (o.pyramid_levels != 3) + (o.search_radius_px != 4.0) +
                            (o.pose_iterations != 10) + (o.local_keyframes != 8) +
                            (o.local_iterations != 5) + (o.global_iterations != 20) +
                            (v.halvings != 0);
    EXPECT_EQ(differences, v.is_default ? 0 : 1) << v.setting << " " << v.value;
  }
  EXPECT_EQ(defaults, (std::map<std::string, int>{{"max_measurements", 1},
                                                  {"max_features_per_keyframe", 1},
                                                  {"pyramid_levels", 1},
                                                  {"search_radius_px", 1},
                                                  {"pose_iterations", 1},
                                                  {"local_keyframes", 1},
                                                  {"local_iterations", 1},
                                                  {"global_iterations", 1},
                                                  {"image_width", 1}}));
  const auto order = [](const Variation& a, const Variation& b) {
    return a.setting != b.setting || a.value < b.value;
  };
  EXPECT_EQ(std::ranges::adjacent_find(variations,
                                       [&](const auto& a, const auto& b) { return !order(a, b); }),
            variations.end());
}

TEST(TrackingBench, LinesHaveTheFieldsPromised) {
  const Footage footage = plain_footage();
  const TrackingResult result = measure_tracking(footage, config::Tracking(), Pace::Awaited, 7);
  EXPECT_EQ(result.frames, 5);
  EXPECT_EQ(result.tracked, 0);
  const auto variation = tracking_variations(config::Tracking(), 32).front();
  const auto json = to_json(footage, variation, 7, result);
  EXPECT_EQ(json["what"], "tracking");
  EXPECT_EQ(json["footage"], "plain");
  EXPECT_EQ(json["setting"], "max_measurements");
  EXPECT_EQ(json["value"], 100);
  EXPECT_EQ(json["default"], false);
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["frames"], 5);
  EXPECT_TRUE(json["error_live"].is_null()) << "nothing was tracked";
  for (const char* field : {"tracked", "keyframes", "points", "mapping_ms", "refinement_ms",
                            "error_unrefined", "error_final"}) {
    EXPECT_TRUE(json.contains(field)) << field;
  }
  for (const char* clock : {"ms", "cpu_ms", "initialising_ms"}) {
    for (const char* field : {"median", "p95", "max"}) {
      EXPECT_TRUE(json[clock][field].is_number()) << clock << " " << field;
    }
  }
  EXPECT_EQ(realtime_to_json(footage, result)["what"], "tracking_realtime");
  EXPECT_TRUE(realtime_to_json(footage, result)["target_ms"]["p95"].is_number());
}

TEST(TrackingBench, ErrorsAreSharesOfTheExtentAndDegrees) {
  TrackingResult result;
  result.live = Accuracy{0.25, 0.5};
  const auto json = realtime_to_json(Footage(), result);
  EXPECT_EQ(json["error_live"]["percent"], 0.25);
  EXPECT_EQ(json["error_live"]["rotation_deg"], 0.5);
}

TEST(TrackingBench, OrbIsComparedWithTheTracker) {
  TrackingResult tracker;
  tracker.wall_ms.median = 3.0;
  tracker.cpu_ms.median = 1.0;
  const auto json = to_json(Footage(), OrbResult{{6.0, 7.0, 8.0}, {4.0, 5.0, 6.0}}, tracker);
  EXPECT_EQ(json["what"], "orb");
  EXPECT_EQ(json["features"], 1000);
  EXPECT_EQ(json["ms"]["median"], 6.0);
  EXPECT_EQ(json["tracker_over_orb"], 0.5);
  EXPECT_EQ(json["tracker_over_orb_cpu"], 0.25);
  EXPECT_TRUE(json["target"].is_number());
}

TEST(TrackingBench, OrbIsMeasuredOnThePictures) {
  const OrbResult orb = measure_orb(plain_footage());
  EXPECT_GT(orb.wall_ms.median, 0.0);
  EXPECT_LE(orb.wall_ms.median, orb.wall_ms.max);
}

}  // namespace
}  // namespace lumibox::bench
