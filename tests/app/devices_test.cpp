#include "app/devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/input_error.h"

namespace lumibox::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string complaint(const config::Devices& options) {
  return testing::message_of([&] { open_devices(options); });
}

TEST(Devices, KindsThatThisBuildDoesNotHaveAreNamedWithThoseItHas) {
  config::Devices options;
  options.camera = "v4l2:/dev/video0";
  EXPECT_THAT(complaint(options), AllOf(HasSubstr("devices.camera"), HasSubstr("v4l2:/dev/video0"),
                                        HasSubstr("not in this build"), HasSubstr("replay:")));
  options.camera = "";
  EXPECT_THAT(complaint(options), HasSubstr("devices.camera"));
  options.clock = "sundial";
  EXPECT_THAT(complaint(options), AllOf(HasSubstr("devices.clock"), HasSubstr("sundial")));
}

TEST(Devices, MissingFilesAreNamed) {
  config::Devices options;
  options.camera = "replay:/nowhere/walk";
  EXPECT_THAT(complaint(options), HasSubstr("/nowhere/walk"));
  options.camera = "sim:/nowhere/scene.toml";
  EXPECT_THAT(complaint(options), HasSubstr("/nowhere/scene.toml"));
}

}  // namespace
}  // namespace lumibox::app
