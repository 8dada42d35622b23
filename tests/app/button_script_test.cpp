#include "app/button_script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/input_error.h"
#include "support/temp_dir.h"

namespace lumibox::app {
namespace {

using ::testing::HasSubstr;

TEST(ButtonScript, ReadsPressesAndComments) {
  const testing::TempDir dir;
  const auto file =
      dir.write("presses.txt", "# what the thumb does\n\n1.5 main\n2 wipe long # oh\n");
  const auto events = read_button_script(file, 0.6);
  Gestures gestures(0.6);
  std::vector<Gesture> told;
  for (const auto& event : events) {
    for (const Gesture& gesture : gestures.update({event}, event.timestamp_ns)) {
      told.push_back(gesture);
    }
  }
  EXPECT_EQ(events.front().timestamp_ns, 1'500'000'000);
  EXPECT_EQ(told, (std::vector<Gesture>{{hal::Button::Main, Press::Short},
                                        {hal::Button::Wipe, Press::Long}}));
}

struct BadScript {
  const char* content;
  const char* complaint;
};

class BadButtonScript : public ::testing::TestWithParam<BadScript> {};

TEST_P(BadButtonScript, IsRefusedWithFileAndLine) {
  const testing::TempDir dir;
  const auto file = dir.write("presses.txt", GetParam().content);
  EXPECT_THAT(testing::message_of([&] { read_button_script(file, 0.6); }),
              HasSubstr(file.string() + GetParam().complaint));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadButtonScript,
    ::testing::Values(BadScript{"1 main\nsoon main\n", ":2: found \"soon main\""},
                      BadScript{"1 fire\n", ":1: found \"1 fire\""},
                      BadScript{"1 main short\n", ":1: found \"1 main short\""},
                      BadScript{"1 main long long\n", ":1: found"},
                      BadScript{"nan main\n", ":1: found"}, BadScript{"-1 main\n", ":1: found"},
                      BadScript{"1\n", ":1: found"},
                      BadScript{"2 main\n1 main\n", ":2: the time goes back"},
                      BadScript{"1 main\n1 plus\n1.1 main\n", ":3: main is still held"},
                      BadScript{"1 main long\n\n1.5 main\n", ":3: main is still held"},
                      BadScript{"1 main\n1 main\n", ":2: main is still held"}));

TEST(ButtonScript, TwoButtonsMayBeHeldAtOnce) {
  const testing::TempDir dir;
  EXPECT_EQ(read_button_script(dir.write("a.txt", "1 main long\n1.1 plus\n2 main\n"), 0.6).size(),
            6U);
}

TEST(ButtonScript, NamesAMissingFileAndAFolder) {
  const testing::TempDir dir;
  EXPECT_THAT(testing::message_of([] { read_button_script("/nowhere/presses.txt", 0.6); }),
              HasSubstr("/nowhere/presses.txt: no such file"));
  EXPECT_THAT(testing::message_of([&] { read_button_script(dir.path(), 0.6); }),
              HasSubstr(dir.path().string() + ": a folder, not a file"));
}

}  // namespace
}  // namespace lumibox::app
