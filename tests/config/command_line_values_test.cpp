#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/loader.h"
#include "support/input_error.h"

namespace lumibox::config {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Config load_set(const std::string& assignment) {
  return load({.system_file = {}, .assignments = {assignment}});
}

std::string complaint_about(const std::string& assignment) {
  return testing::message_of([&] { load_set(assignment); });
}

TEST(CommandLineValues, SetEachKindOfValue) {
  EXPECT_EQ(load_set("render.k=50").render.k, 50);
  EXPECT_EQ(load_set("render.exponent=3").render.exponent, 3.0);
  EXPECT_EQ(load_set("render.exponent=2.5e0").render.exponent, 2.5);
  EXPECT_EQ(load_set("log.level=warn").log.level, "warn");
  EXPECT_EQ(load_set("devices.camera=sim:a=b.toml").devices.camera, "sim:a=b.toml");
}

TEST(CommandLineValues, WithoutFormAreRefused) {
  for (const char* text : {"", "=", "render", "render.k", "k=40", "render.=4", ".k=4", "a.b.c=1"}) {
    EXPECT_THAT(complaint_about(text), HasSubstr("--set " + std::string(text))) << text;
  }
}

TEST(CommandLineValues, UnknownKeyNamesAssignmentAndNeighbour) {
  EXPECT_THAT(complaint_about("render.kk=40"),
              AllOf(HasSubstr("--set render.kk=40"), HasSubstr("did you mean 'render.k'")));
}

TEST(CommandLineValues, WrongTypeAndRangeNameAssignmentAndWhatIsAllowed) {
  for (const char* value : {"", "x", "40.5", "0", "257", "nan", "40 ", "true", "0x10"}) {
    const std::string assignment = std::string("render.k=") + value;
    EXPECT_THAT(complaint_about(assignment),
                AllOf(HasSubstr("--set " + assignment), HasSubstr("1 to 128")));
  }
  for (const char* value : {"nan", "inf", "-1", "65"}) {
    const std::string assignment = std::string("render.exponent=") + value;
    EXPECT_THAT(complaint_about(assignment),
                AllOf(HasSubstr("--set " + assignment), HasSubstr("0 to 64")));
  }
}

}  // namespace
}  // namespace lumibox::config
