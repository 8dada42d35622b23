#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "geometry/camera.h"
#include "hal/sim/frame_renderer.h"
#include "hal/sim/image_stages.h"
#include "hal/sim_scenes.h"

// Each effect against what it promises.
namespace lumibox::hal {
namespace {

using testing::frame_alone;
using testing::scene_of;
using testing::wall_scene;

constexpr const char* kNoise = "[[effects]]\nkind = \"sensor_noise\"\nfull_well = 500.0\n";
constexpr const char* kBlur =
    "[[effects]]\nkind = \"motion_blur\"\nexposure_s = 0.04\nsamples = 4\n";

TEST(SimEffects, RollingShutterSeesEachRowFromItsOwnPose) {
  const auto scene =
      scene_of(wall_scene("[[effects]]\nkind = \"rolling_shutter\"\nreadout_s = 0.04\n"));
  const geometry::Camera camera(scene->profile());
  EXPECT_EQ(scene->profile().readout_s, 0.04);
  const Image frame = frame_alone(scene, 10);
  for (const int row : {0, 40, 119}) {
    const double time_s = 0.5 + 0.04 * (row / 119.0 - 0.5);
    const Image ideal = scene->render_ideal(camera, scene->world_from_camera(time_s), time_s);
    EXPECT_EQ(std::memcmp(frame.row(row), ideal.row(row), frame.stride()), 0) << row;
  }
  const Image middle = scene->render_ideal(camera, scene->world_from_camera(0.5), 0.5);
  EXPECT_NE(std::memcmp(frame.row(0), middle.row(0), frame.stride()), 0);
}

TEST(SimEffects, BlurLeavesAStillCameraAlone) {
  EXPECT_EQ(frame_alone(scene_of(wall_scene(kBlur, "0.0")), 3),
            frame_alone(scene_of(wall_scene("", "0.0")), 3));
}

TEST(SimEffects, BlurSmoothsWhenTheCameraMoves) {
  const auto roughness = [](const Image& image) {
    double sum = 0.0;
    for (int x = 1; x < image.width(); ++x)
      sum += std::abs(image.at(x, 60)[0] - image.at(x - 1, 60)[0]);
    return sum;
  };
  EXPECT_LT(roughness(frame_alone(scene_of(wall_scene(kBlur, "1.5")), 10)),
            0.9 * roughness(frame_alone(scene_of(wall_scene("", "1.5")), 10)));
}

TEST(SimEffects, NoiseHasTheVarianceOfItsModel) {
  constexpr float kLevel = 0.25f;
  constexpr float kGain = 4.0f;
  sim::LinearImage image(200, 200);
  std::fill(image.pixels.begin(), image.pixels.end(), sim::Color::Constant(kLevel));
  sim::Exposure exposure;
  exposure.gain = kGain;
  sim::SensorNoise({.full_well = 2000.0, .read = 6.0, .seed = 1}).apply(image, exposure);
  double sum = 0.0;
  double sum2 = 0.0;
  for (const sim::Color& pixel : image.pixels) {
    for (const float value : pixel) {
      sum += static_cast<double>(value);
      sum2 += static_cast<double>(value) * static_cast<double>(value);
    }
  }
  const double n = 3.0 * 200 * 200;
  const double electrons = 2000.0 / 4.0;  // that make a full signal at this gain
  const double expected = (0.25 * electrons + 36.0) / (electrons * electrons);
  EXPECT_NEAR(sum / n, 0.25, 4.0 * std::sqrt(expected / n));
  EXPECT_NEAR((sum2 - sum * sum / n) / n, expected, 0.03 * expected);
}

TEST(SimEffects, NoiseBelongsToTheFrameNotToTheHistory) {
  const auto scene = scene_of(wall_scene(kNoise, "0.0"));
  VirtualClock clock;
  SimCamera camera(scene, clock);
  camera.start();
  Image last;
  for (int i = 0; i <= 5; ++i) {
    clock.wait_until(scene->timestamp_ns(i));
    const Image now = *camera.take_newest()->color;
    EXPECT_NE(now, last);  // nothing moves: only the noise differs
    last = now;
  }
  EXPECT_EQ(last, frame_alone(scene, 5));
}

TEST(SimEffects, ExposureConvergesWithItsTimeConstantAndHoldsWhenLocked) {
  sim::AutoExposure stage({.target = 0.2, .lag_s = 0.5, .min_gain = 0.1, .max_gain = 16.0});
  sim::Exposure exposure;
  const auto gain_at = [&](double time_s, float level, bool locked) {
    sim::LinearImage image(8, 8);
    std::fill(image.pixels.begin(), image.pixels.end(), sim::Color::Constant(level));
    exposure.time_s = time_s;
    exposure.locked = locked;
    stage.apply(image, exposure);
    EXPECT_NEAR(image.pixels[5][1], level * exposure.gain, 1e-5f);
    return static_cast<double>(exposure.gain);
  };
  EXPECT_EQ(gain_at(0.0, 0.05f, false), 1.0);
  EXPECT_NEAR(gain_at(0.5, 0.05f, false), 1.0 + 3.0 * (1.0 - std::exp(-1.0)), 1e-3);
  for (double time_s = 1.0; time_s < 5.0; time_s += 0.1) gain_at(time_s, 0.05f, false);
  EXPECT_NEAR(gain_at(5.0, 0.05f, false), 4.0, 0.01);
  EXPECT_NEAR(gain_at(7.0, 0.4f, true), 4.0, 0.01);
  EXPECT_NEAR(gain_at(9.0, 0.4f, false), 0.5, 0.1);
}

TEST(SimEffects, VignettingDarkensTheCornersToItsValue) {
  const config::CameraProfile profile;
  sim::Vignetting stage({.corner = 0.5}, profile);
  sim::LinearImage image(profile.width, profile.height);
  std::fill(image.pixels.begin(), image.pixels.end(), sim::Color::Ones());
  sim::Exposure exposure;
  stage.apply(image, exposure);
  EXPECT_NEAR(image.row(0)[0][0], 0.5f, 1e-4f);
  EXPECT_NEAR(image.row(240)[320][0], 1.0f, 1e-4f);
}

TEST(SimEffects, DroppedFramesAreMissingAndCounted) {
  const auto scene = scene_of(
      wall_scene("[[effects]]\nkind = \"dropped_frames\"\nshare = 0.2\nburst = 2\nseed = 3\n"));
  const sim::EffectSpecs& effects = scene->impl().spec.effects;
  VirtualClock clock;
  SimCamera camera(scene, clock);
  camera.start();
  std::int64_t lost = 0;
  for (std::int64_t i = 0; i < scene->frame_count(); ++i) {
    clock.wait_until(scene->timestamp_ns(i));
    const bool dropped = sim::is_dropped(effects, i);
    EXPECT_EQ(camera.take_newest().has_value(), !dropped) << i;
    lost += dropped ? 1 : 0;
  }
  EXPECT_GT(lost, 0);
  EXPECT_LT(lost, scene->frame_count() / 2);
  EXPECT_EQ(camera.counters().dropped, lost);
  EXPECT_EQ(camera.state(), CameraState::Ended);
}

TEST(SimEffects, OccluderPassesOnlyInItsTime) {
  constexpr const char* kOccluder = R"(
[[effects]]
kind = "passing_occluder"
size = [0.2, 0.2, 0.2]
from = [-1.5, 0.5, 0.0]
to = [1.5, 0.5, 0.0]
start_s = 0.3
duration_s = 0.4
)";
  const auto with = scene_of(wall_scene(kOccluder));
  const auto without = scene_of(wall_scene());
  SimCost cost;
  EXPECT_EQ(frame_alone(with, 0, &cost), frame_alone(without, 0));
  EXPECT_EQ(cost.world_updates, 0);
  EXPECT_NE(frame_alone(with, 10, &cost), frame_alone(without, 10));
  EXPECT_EQ(cost.world_updates, 1);
  EXPECT_EQ(frame_alone(with, 18), frame_alone(without, 18));
}

TEST(SimEffects, MovingSubjectMovesAndComesBackToTheBit) {
  const auto scene = scene_of(testing::ball_scene(0.0, 2.0, 0.0, R"(
[[effects]]
kind = "moving_subject"
objects = ["ball"]
pivot = [0.0, 2.0, 0.0]
position_mm = 100.0
max_hz = 2.0
)"));
  const Image early = frame_alone(scene, 2);
  EXPECT_NE(early, frame_alone(scene, 12));
  EXPECT_EQ(early, frame_alone(scene, 2));
}

}  // namespace
}  // namespace lumibox::hal
