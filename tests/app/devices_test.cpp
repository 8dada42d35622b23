#include "app/devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "hal/offscreen/offscreen_display.h"
#include "support/input_error.h"
#include "support/recording.h"
#include "support/temp_dir.h"

namespace lumibox::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string complaint(const config::Config& config) {
  return testing::message_of([&] { open_devices(config); });
}

TEST(Devices, KindsThatThisBuildDoesNotHaveAreNamedWithThoseItHas) {
  config::Config config;
  config.devices.camera = "pinhole:/dev/box";
  EXPECT_THAT(complaint(config), AllOf(HasSubstr("devices.camera"), HasSubstr("pinhole:/dev/box"),
                                       HasSubstr("not in this build"), HasSubstr("replay:")));
  config.devices.camera = "";
  EXPECT_THAT(complaint(config),
              AllOf(HasSubstr("devices.camera is not set"), HasSubstr("sim:SCENE.toml")));
  config.devices.clock = "sundial";
  EXPECT_THAT(complaint(config), AllOf(HasSubstr("devices.clock"), HasSubstr("sundial")));
}

TEST(Devices, KindsWithoutANameAreRefused) {
  config::Config config;
  for (const char* camera : {"sim", "sim:", "replay", "replay:", "v4l2", "v4l2:", "libcamera:"}) {
    config.devices.camera = camera;
    EXPECT_THAT(complaint(config), HasSubstr("without a name; expected")) << camera;
  }
  const testing::Recording recording;
  config.devices.camera = "replay:" + recording.folder().string();
  config.devices.buttons = "script:";
  EXPECT_THAT(complaint(config), HasSubstr("devices.buttons: \"script\" without a name"));
}

TEST(Devices, SeveralKindsOfButtonsAreOne) {
  const testing::Recording recording;
  const testing::TempDir folder;
  const std::string one = folder.write("one.txt", "0 main\n").string();
  const std::string other = folder.write("other.txt", "0 wipe\n").string();
  config::Config config;
  config.devices.camera = "replay:" + recording.folder().string();
  config.devices.clock = "virtual";
  config.devices.buttons = "script:" + one + " , script:" + other + ",none";
  const Devices devices = open_devices(config);
  devices.clock->wait_until(devices.clock->now_ns() + 100'000'000);
  std::set<hal::Button> pressed;
  for (const hal::ButtonEvent& event : devices.buttons->poll()) pressed.insert(event.button);
  EXPECT_EQ(pressed, (std::set{hal::Button::Main, hal::Button::Wipe}));
}

TEST(Devices, ButtonsAndALampThatAreNotThereAreNamed) {
  const testing::Recording recording;
  config::Config config;
  config.devices.camera = "replay:" + recording.folder().string();
  config.devices.buttons = "gpio";
  EXPECT_THAT(complaint(config), HasSubstr("no button has a line"));
  config.gpio.main = "no such line";
  EXPECT_THAT(complaint(config), AllOf(HasSubstr("gpio.main"), HasSubstr("\"no such line\"")));
  config.devices.buttons = "none, evdev";
  EXPECT_THAT(complaint(config), HasSubstr("\"evdev\" without a name; expected evdev:any"));
  config.devices.buttons = "evdev:" + recording.dir().write("a file", "").string();
  EXPECT_THAT(complaint(config), HasSubstr("expected an input device"));
  for (const char* buttons : {"gpio:4", "mouse", "none, mouse"}) {
    config.devices.buttons = buttons;
    EXPECT_THAT(complaint(config), AllOf(HasSubstr("devices.buttons"),
                                         HasSubstr("not in this build"), HasSubstr("evdev:any")))
        << buttons;
  }
  for (const std::string buttons : {"", ",", "none,", "none,,none", " "}) {
    config.devices.buttons = buttons;
    EXPECT_THAT(complaint(config), HasSubstr("devices.buttons: \"" + buttons + "\" names nothing"));
  }
  config.devices.buttons = "none";
  config.devices.status_led = "gpio:no such line";
  EXPECT_THAT(complaint(config),
              AllOf(HasSubstr("devices.status_led"), HasSubstr("\"no such line\"")));
  config.devices.status_led = "gpio:";
  EXPECT_THAT(complaint(config), HasSubstr("devices.status_led: \"gpio\" without a name"));
  config.devices.status_led = "torch";
  EXPECT_THAT(complaint(config), HasSubstr("devices.status_led: \"torch\" is not in this build"));
}

TEST(Devices, HandsDoNotPressOnTheVirtualClock) {
  const testing::Recording recording;
  config::Config config;
  config.devices.camera = "replay:" + recording.folder().string();
  config.devices.clock = "virtual";
  for (const char* buttons : {"gpio", "evdev:any", "none, evdev:A remote", "window"}) {
    config.devices.buttons = buttons;
    EXPECT_THAT(complaint(config), AllOf(HasSubstr("devices.buttons"), HasSubstr("devices.clock"),
                                         HasSubstr("expected \"system\"")))
        << buttons;
  }
}

TEST(Devices, KeysOfAWindowNeedTheWindow) {
  const testing::Recording recording;
  config::Config config;
  config.devices.camera = "replay:" + recording.folder().string();
  config.devices.buttons = "none, window";
  EXPECT_THAT(complaint(config),
              AllOf(HasSubstr("devices.buttons: \"window\""), HasSubstr("offscreen:640x480"),
                    HasSubstr("expected \"window\" there too")));
}

TEST(Devices, SizesOfPicturesAreOnes) {
  const testing::Recording recording;
  config::Config config;
  config.devices.camera = "replay:" + recording.folder().string();
  for (const char* display : {"offscreen", "offscreen:640", "window:640x", "window:0x480"}) {
    config.devices.display = display;
    EXPECT_THAT(complaint(config), AllOf(HasSubstr("devices.display"), HasSubstr("has no size")))
        << display;
  }
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

TEST(Devices, ARealCameraNeedsRealTimeAndACalibrationThatCanBeRead) {
  config::Config config;
  config.devices.camera = "v4l2:/nowhere/video";
  config.devices.calibration = "/nowhere/own.toml";
  EXPECT_THAT(complaint(config), HasSubstr("/nowhere/own.toml"));
  config.devices.clock = "virtual";
  EXPECT_THAT(complaint(config), AllOf(HasSubstr("devices.clock"), HasSubstr("real camera")));
}

TEST(Devices, TheScreenAndItsModeAreNamed) {
  const testing::Recording recording;
  config::Config config;
  config.devices.camera = "replay:" + recording.folder().string();
  config.devices.display = "kms:/nowhere/card0";
  config.display.mode = "huge";
  EXPECT_THAT(complaint(config),
              AllOf(HasSubstr("display.mode: \"huge\" is no mode"), HasSubstr("1280x720@60")));
  config.devices.display = "hologram:640x480";
  EXPECT_THAT(complaint(config), AllOf(HasSubstr("devices.display"), HasSubstr("kms:CARD")));
}

TEST(Devices, ACameraAndAScreenThatAreNotThereAreMissingAndMayCome) {
  const testing::Recording recording;
  config::Config config;
  config.devices.camera = "v4l2:/nowhere/video";
  config.devices.display = "offscreen:32x24";
  Devices devices = open_devices(config);
  EXPECT_FALSE(devices.camera);
  EXPECT_THAT(devices.missing,
              AllOf(HasSubstr("devices.camera: /nowhere/video"), HasSubstr("No such file")));
  EXPECT_EQ(devices.display->width(), 32);
  config.devices.camera = "libcamera:no such camera";
  EXPECT_THAT(open_devices(config).missing, HasSubstr("devices.camera: libcamera finds no camera"));
  config.devices.camera = "replay:" + recording.folder().string();
  config.devices.display = "kms:/nowhere/card0";
  devices = Devices();
  devices = open_devices(config);
  EXPECT_FALSE(devices.display);
  EXPECT_EQ(devices.missing,
            "display kms: /nowhere/card0: No such file or directory; expected a "
            "graphics card");
  EXPECT_EQ(devices.camera->state(), hal::CameraState::Stopped) << "nobody would see it";
  open_missing(devices);
  EXPECT_THAT(devices.missing, HasSubstr("/nowhere/card0")) << "still";
  devices.open_display = [] { return std::make_unique<hal::OffscreenDisplay>(32, 24); };
  open_missing(devices);
  EXPECT_EQ(devices.missing, "");
  EXPECT_EQ(devices.camera->state(), hal::CameraState::Streaming);
}

TEST(Devices, NothingComesWhereTimeIsVirtual) {
  const testing::Recording recording;
  config::Config config;
  config.devices.camera = "replay:" + recording.folder().string();
  config.devices.display = "kms:/nowhere/card0";
  config.devices.clock = "virtual";
  EXPECT_THAT(complaint(config), HasSubstr("/nowhere/card0"));
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
