#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <future>
#include <string>

#include "hal/desk.h"
#include "support/small_scene.h"
#include "support/source_file.h"
#include "support/temp_dir.h"

namespace lumibox::app {
namespace {

/// A scene that is looked at for longer than any test takes.
std::string endless_scene() {
  std::string scene = testing::kSmallScene;
  const std::string duration = "duration_s = 2.0";
  return scene.replace(scene.find(duration), duration.size(), "duration_s = 3600.0");
}

TEST(WindowOfARun, EndsItWhenItIsClosed) {
  const testing::Desktop desktop;
  const auto desk = testing::Desk::open();
  if (!desk) GTEST_SKIP() << "no desktop here; Debian's package xvfb has one for tests";
  const testing::TempDir dir;
  // Nobody else would end a run whose window never comes.
  const std::string command =
      "timeout 300 " + std::string(LUMIBOX_EXECUTABLE) +
      " run --set devices.display=window --set devices.buttons=window" +
      " --set devices.camera=sim:" + dir.write("scene.toml", endless_scene()).string() +
      " --set capture.folder=" + (dir / "captures").string() + " >" + (dir / "said").string() +
      " 2>&1";
  std::future<int> run =
      std::async(std::launch::async, [&] { return std::system(command.c_str()); });
  const auto ended = [&] {
    return run.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  };
  while (!desk->sees_window() && !ended()) continue;
  ASSERT_FALSE(ended()) << testing::read_text(dir / "said");
  desk->close();
  EXPECT_EQ(run.get(), 0);
}

}  // namespace
}  // namespace lumibox::app
