#include "hal/device_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temp_dir.h"

namespace lumibox::hal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(DeviceFiles, AreThoseOfAPrefixInOrder) {
  const testing::TempDir dir;
  for (const char* name : {"event2", "event1", "mouse0"}) dir.write(name, "");
  EXPECT_THAT(device_files(dir.path(), "event"), ElementsAre(dir / "event1", dir / "event2"));
  EXPECT_EQ(device_files(dir.path()).size(), 3U);
}

TEST(DeviceFiles, AreNoneWhereNothingIsPluggedIn) {
  EXPECT_THAT(device_files("/nowhere/by-id"), IsEmpty());
}

}  // namespace
}  // namespace lumibox::hal
