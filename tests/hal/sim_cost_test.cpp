#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "hal/sim_scenes.h"

// What a frame of each shipped scene costs: exactly what its effects call for and nothing else.
namespace lumibox::hal {
namespace {

using ::testing::ElementsAre;

constexpr std::int64_t kPixels = 640 * 480;

SimCost cost_of(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(LUMIBOX_SOURCE_DIR) / "hal/sim/scenes";
  SimCost cost;
  const Image image = testing::frame_alone(load_scene(folder / (name + ".toml")), 1, &cost);
  EXPECT_FALSE(image.empty());
  return cost;
}

class PlainScene : public ::testing::TestWithParam<const char*> {};

TEST_P(PlainScene, CostsOneRayPerPixelAndNothingElse) {
  const SimCost cost = cost_of(GetParam());
  EXPECT_EQ(cost.camera_rays, kPixels);
  EXPECT_EQ(cost.secondary_rays, 0);
  EXPECT_EQ(cost.poses, 1);
  EXPECT_EQ(cost.world_updates, 0);
  EXPECT_THAT(cost.stages, ElementsAre("tone_mapping"));
}

INSTANTIATE_TEST_SUITE_P(SimCost, PlainScene, ::testing::Values("toy", "statue_orbit", "facade"),
                         [](const auto& test) { return std::string(test.param); });

TEST(SimCost, CrystalBallAddsRaysOnlyWhereGlassAndMirrorAre) {
  const SimCost cost = cost_of("crystal_ball");
  EXPECT_EQ(cost.camera_rays, kPixels);
  EXPECT_GT(cost.secondary_rays, kPixels / 50);
  EXPECT_LT(cost.secondary_rays, kPixels);
  EXPECT_THAT(cost.stages, ElementsAre("tone_mapping"));
}

TEST(SimCost, PersonAddsOneUpdateAndTheNoise) {
  const SimCost cost = cost_of("person");
  EXPECT_EQ(cost.camera_rays, kPixels);
  EXPECT_EQ(cost.secondary_rays, 0);
  EXPECT_EQ(cost.world_updates, 1);
  EXPECT_THAT(cost.stages, ElementsAre("sensor_noise", "tone_mapping"));
}

TEST(SimCost, NightWebcamAddsSamplesPosesAndStages) {
  const SimCost cost = cost_of("night_webcam");
  EXPECT_EQ(cost.camera_rays, 4 * kPixels);
  EXPECT_EQ(cost.secondary_rays, 0);
  EXPECT_EQ(cost.poses, 4 * 480);
  EXPECT_EQ(cost.world_updates, 0);  // nobody walks past yet
  EXPECT_THAT(cost.stages,
              ElementsAre("vignetting", "auto_exposure", "sensor_noise", "tone_mapping"));
}

}  // namespace
}  // namespace lumibox::hal
