#include "app/devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/input_error.h"
#include "support/recording.h"

namespace lumibox::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string complaint(const config::Config& config) {
  return testing::message_of([&] { open_devices(config); });
}

TEST(Devices, KindsThatThisBuildDoesNotHaveAreNamedWithThoseItHas) {
  config::Config config;
  config.devices.camera = "v4l2:/dev/video0";
  EXPECT_THAT(complaint(config), AllOf(HasSubstr("devices.camera"), HasSubstr("v4l2:/dev/video0"),
                                       HasSubstr("not in this build"), HasSubstr("replay:")));
  config.devices.camera = "";
  EXPECT_THAT(complaint(config),
              AllOf(HasSubstr("devices.camera is not set"), HasSubstr("sim:SCENE.toml")));
  config.devices.clock = "sundial";
  EXPECT_THAT(complaint(config), AllOf(HasSubstr("devices.clock"), HasSubstr("sundial")));
}

TEST(Devices, KindsWithoutANameAreRefused) {
  config::Config config;
  for (const char* camera : {"sim", "sim:", "replay", "replay:"}) {
    config.devices.camera = camera;
    EXPECT_THAT(complaint(config), HasSubstr("without a name; expected")) << camera;
  }
  const testing::Recording recording;
  config.devices.camera = "replay:" + recording.folder().string();
  config.devices.buttons = "script:";
  EXPECT_THAT(complaint(config), HasSubstr("devices.buttons: \"script\" without a name"));
}

TEST(Devices, ACalibrationOverridesTheRecordings) {
  const testing::Recording recording;
  config::Config config;
  config.devices.camera = "replay:" + recording.folder().string();
  config.devices.calibration =
      recording.dir()
          .write("own.toml", "width = 32\nheight = 24\nfx = 44\nfy = 44\ncx = 15\ncy = 11\n")
          .string();
  EXPECT_EQ(open_devices(config).camera->profile().fx, 44.0);
  config.devices.camera = "sim:toy.toml";
  EXPECT_THAT(complaint(config), HasSubstr("devices.calibration"));
}

TEST(Devices, MissingFilesAreNamed) {
  config::Config config;
  config.devices.camera = "replay:/nowhere/walk";
  EXPECT_THAT(complaint(config), HasSubstr("/nowhere/walk"));
  config.devices.camera = "sim:/nowhere/scene.toml";
  EXPECT_THAT(complaint(config), HasSubstr("/nowhere/scene.toml"));
}

}  // namespace
}  // namespace lumibox::app
