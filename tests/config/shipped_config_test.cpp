#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "config/loader.h"
#include "config/schema.h"
#include "support/source_file.h"

namespace lumibox::config {
namespace {

const std::string kShipped = std::string(LUMIBOX_SOURCE_DIR) + "/config/lumibox.toml";

std::vector<std::string> statements(Config& config) {
  std::vector<std::string> all;
  for (const Key& key : schema(config)) {
    all.push_back(key.full_name() + ": " + key.statement());
  }
  return all;
}

TEST(ShippedConfig, StatesTheDefaults) {
  Config shipped = load({.system_file = {}, .file = kShipped});
  Config defaults;
  EXPECT_EQ(statements(shipped), statements(defaults));
}

TEST(ShippedConfig, TheBoxBeginsWithSettingsThatAreAllowed) {
  const std::string file = std::string(LUMIBOX_SOURCE_DIR) + "/systemd/appliance.toml";
  const Config config = load({.system_file = {}, .file = file});
  EXPECT_EQ(config.devices.display, "kms");
  EXPECT_THAT(config.capture.folder, ::testing::StartsWith("/var/lib/lumibox/"));
}

// What a person reads above a key is what the program enforces: the line before each key is the
// schema's own statement of its default, unit, range and origin, and prose stands before that.
TEST(ShippedConfig, StatesEveryKeyWithUnitRangeAndOrigin) {
  std::vector<std::string> lines;
  std::istringstream text(testing::read_text(kShipped));
  for (std::string line; std::getline(text, line);) {
    lines.push_back(line);
  }
  Config defaults;
  std::string section;
  std::size_t at = 0;
  for (const Key& key : schema(defaults)) {
    if (key.section != section) {
      section = key.section;
      at = 0;
      while (at < lines.size() && lines[at] != "[" + section + "]") ++at;
      ASSERT_LT(at, lines.size()) << "no section [" << section << "]";
    }
    const std::string start = std::string(key.name) + " = ";
    while (at < lines.size() && !lines[at].starts_with(start)) ++at;
    ASSERT_LT(at, lines.size()) << key.full_name() << " is missing or out of order";
    EXPECT_EQ(lines[at - 1], "# " + key.statement()) << key.full_name();
    EXPECT_THAT(lines[at - 2], ::testing::StartsWith("# ")) << key.full_name() << ": no prose";
    EXPECT_FALSE(key.unit.empty() || key.origin.empty()) << key.full_name();
  }
}

}  // namespace
}  // namespace lumibox::config
