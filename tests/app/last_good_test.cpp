#include "app/last_good.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/input_error.h"
#include "support/recording.h"
#include "support/source_file.h"

namespace lumibox::app {
namespace {

using ::testing::HasSubstr;

class LastGood : public ::testing::Test {
 protected:
  /// Settings with a rate of their own, by which they are known, a display and a folder for
  /// captures.
  std::string settings(const std::string& rate, const std::string& display = "offscreen:32x24",
                       const std::string& folder = "captures") {
    return "[loop]\nrate_hz = " + rate +
           "\n[devices]\ncamera = \"replay:" + recording_.folder().string() + "\"\ndisplay = \"" +
           display + "\"\n[capture]\nfolder = \"" + (recording_.dir() / folder).string() + "\"\n";
  }
  config::Sources sources(const std::string& text) {
    return {.system_file = {}, .file = recording_.dir().write("lumibox.toml", text)};
  }

  const testing::Recording recording_;
  const std::filesystem::path good_ = recording_.dir() / "good.toml";
};

TEST_F(LastGood, SettingsThatWorkAreUsed) {
  recording_.dir().write("good.toml", settings("7"));
  const OpenBox box = open_box(sources(settings("9")), good_);
  EXPECT_EQ(box.config.loop.rate_hz, 9.0);
  EXPECT_FALSE(box.problem);
}

TEST_F(LastGood, ThoseThatDoNotGiveWayToTheLastGoodOnes) {
  recording_.dir().write("good.toml", settings("7"));
  for (const std::string& wrong :
       {settings("-1"), std::string("no TOML"), settings("9", "kms:/nowhere/card0"),
        settings("9", "offscreen:32x24", "lumibox.toml/captures")}) {
    const OpenBox box = open_box(sources(wrong), good_);
    EXPECT_EQ(box.config.loop.rate_hz, 7.0) << wrong;
    EXPECT_EQ(box.devices.display->width(), 32);
    ASSERT_TRUE(box.problem);
  }
  EXPECT_THAT(*open_box(sources(settings("-1")), good_).problem, HasSubstr("lumibox.toml:2"));
}

TEST_F(LastGood, WithoutThemTheFaultIsSaid) {
  EXPECT_THAT(testing::message_of([&] { open_box(sources(settings("-1")), good_); }),
              HasSubstr("lumibox.toml:2"));
  EXPECT_THAT(testing::message_of([&] { open_box(sources(settings("-1")), std::nullopt); }),
              HasSubstr("lumibox.toml:2"));
}

TEST_F(LastGood, IfNeitherWillDoTheLatterIsSaid) {
  recording_.dir().write("good.toml", settings("-7"));
  EXPECT_THAT(testing::message_of([&] { open_box(sources(settings("-1")), good_); }),
              HasSubstr("good.toml:2"));
}

// The settings are right, and the screen is unplugged: it will come.
TEST_F(LastGood, WhereTheyDoNotHaveTheDeviceEitherItIsWaitedFor) {
  const std::string unplugged = settings("9", "kms:/nowhere/card0");
  for (const std::string& good : {settings("7", "kms:/nowhere/card1"), settings("-7"), unplugged}) {
    recording_.dir().write("good.toml", good);
    const OpenBox box = open_box(sources(unplugged), good_);
    EXPECT_EQ(box.config.loop.rate_hz, 9.0);
    EXPECT_FALSE(box.problem);
    EXPECT_THAT(box.devices.missing, HasSubstr("/nowhere/card0"));
  }
  EXPECT_THAT(open_box(sources(unplugged), std::nullopt).devices.missing, HasSubstr("card0"));
}

TEST_F(LastGood, AreACopyOfWhatWorked) {
  const OpenBox box = open_box(sources(settings("9")), good_);
  sources("changed [[ meanwhile");
  keep_last_good(box.settings, good_);
  EXPECT_EQ(testing::read_text(good_), settings("9"));
  const auto written = std::filesystem::last_write_time(good_);
  keep_last_good(box.settings, good_);
  EXPECT_EQ(std::filesystem::last_write_time(good_), written) << "not written without need";
  keep_last_good(settings("11"), good_);
  EXPECT_EQ(testing::read_text(good_), settings("11"));
}

TEST_F(LastGood, AreNotKeptOverADeviceAFolderOrALink) {
  const std::filesystem::path link = recording_.dir() / "link";
  std::filesystem::create_symlink(good_, link);
  recording_.dir().write("good.toml", settings("7"));
  for (const auto& place : {std::filesystem::path("/dev/null"), recording_.folder(), link}) {
    EXPECT_THAT(testing::message_of([&] { check_last_good(place); }), HasSubstr(place.string()));
  }
  EXPECT_NO_THROW(check_last_good(good_));
  EXPECT_NO_THROW(check_last_good(recording_.dir() / "new.toml"));
}

TEST_F(LastGood, AreNotKeptInACapture) {
  recording_.dir().write("transforms.json", R"({"frames": [], "lumibox": {"version": 1}})");
  EXPECT_NE(testing::message_of([&] { check_last_good(recording_.dir() / "transforms.json"); }),
            "");
}

TEST_F(LastGood, ThatCannotBeKeptAreAWarning) {
  ::testing::internal::CaptureStdout();
  keep_last_good(settings("9"), "/nowhere/good.toml");
  EXPECT_THAT(::testing::internal::GetCapturedStdout(), HasSubstr("/nowhere/good.toml"));
}

}  // namespace
}  // namespace lumibox::app
