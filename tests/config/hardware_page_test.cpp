// Who builds a box copies its settings from the docs: they are settings that the program takes, and
// say the same as the wiring.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "config/loader.h"
#include "support/input_error.h"
#include "support/source_file.h"
#include "support/temp_dir.h"

namespace lumibox::config {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

std::string page(const std::string& name) {
  return testing::read_text(std::string(LUMIBOX_SOURCE_DIR) + "/docs/" + name);
}

/// The indented blocks of a page that begin with a section, as they would stand in lumibox.toml.
std::vector<std::string> settings_in(const std::string& page) {
  std::vector<std::string> blocks;
  std::istringstream text(page);
  bool within = false;
  for (std::string line; std::getline(text, line);) {
    const bool indented = line.starts_with("    ");
    if (indented && !within && line.starts_with("    [")) {
      blocks.emplace_back();
      within = true;
    }
    within = within && (indented || line.empty());
    if (within) blocks.back() += (indented ? line.substr(4) : line) + "\n";
  }
  return blocks;
}

Config load_text(const std::string& settings) {
  const testing::TempDir folder;
  return load({.system_file = {}, .file = folder.write("lumibox.toml", settings)});
}

TEST(SettingsInTheDocs, AreTakenByTheProgram) {
  for (const char* name : {"hardware.md", "buttons.md"}) {
    const std::vector<std::string> blocks = settings_in(page(name));
    EXPECT_GE(blocks.size(), 3U) << name;
    for (const std::string& block : blocks) {
      EXPECT_EQ(testing::message_of([&] { load_text(block); }), "") << name << ":\n" << block;
    }
  }
}

TEST(SettingsInTheDocs, OfTheWiredBoxAreItsWiring) {
  const std::string text = page("hardware.md");
  const Config config = load_text(settings_in(text).front());
  struct Wire {
    const char* name;
    std::string line;
    int bcm;  ///< number of the line, as in its name
    int pin;  ///< of the 40-pin header
  };
  for (const Wire& wire : {Wire{"Main", config.gpio.main, 5, 29},      //
                           Wire{"Review", config.gpio.review, 6, 31},  //
                           Wire{"\\+", config.gpio.plus, 13, 33},      //
                           Wire{"−", config.gpio.minus, 19, 35},       //
                           Wire{"Wipe", config.gpio.wipe, 26, 37}}) {
    const std::string line = "GPIO" + std::to_string(wire.bcm);
    const std::string pin = std::to_string(wire.pin);
    EXPECT_EQ(wire.line, line) << wire.name;
    EXPECT_THAT(text, ContainsRegex(std::string("\\| ") + wire.name + " \\| `" + line + "` \\| " +
                                    pin + " \\|"));
    EXPECT_THAT(text, ContainsRegex(std::string("    ") + wire.name + " +" + line + " +" + pin));
  }
  EXPECT_EQ(config.devices.status_led, "gpio:GPIO21");
  EXPECT_THAT(text, HasSubstr("| lamp | `GPIO21` | 40 |"));
}

}  // namespace
}  // namespace lumibox::config
