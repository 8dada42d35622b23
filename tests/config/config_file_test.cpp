#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/loader.h"
#include "support/input_error.h"
#include "support/temp_dir.h"

namespace lumibox::config {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class ConfigFile : public ::testing::Test {
 protected:
  /// Loads a file of this text and nothing else.
  Config load_text(const std::string& text) const {
    return load({.system_file = folder_ / "absent.toml", .file = folder_.write("box.toml", text)});
  }

  std::string complaint_about(const std::string& text) const {
    return testing::message_of([&] { load_text(text); });
  }

  std::string at_line(int line) const {
    return (folder_ / "box.toml").string() + ":" + std::to_string(line) + ": ";
  }

  testing::TempDir folder_;
};

TEST_F(ConfigFile, WithoutContentGivesTheDefaults) {
  EXPECT_EQ(load_text("").loop.rate_hz, Config{}.loop.rate_hz);
}

TEST_F(ConfigFile, SetsEachKindOfValue) {
  const Config config = load_text(
      "[render]\nk = 50\nexponent = 3\nfeather_px = 12.5\n"
      "[log]\nlevel = 'debug'\n");
  EXPECT_EQ(config.render.k, 50);
  EXPECT_EQ(config.render.exponent, 3.0) << "a whole number is a number";
  EXPECT_EQ(config.render.feather_px, 12.5);
  EXPECT_EQ(config.log.level, "debug");
}

TEST_F(ConfigFile, UnknownKeyNamesLineKeyAndNeighbour) {
  EXPECT_THAT(complaint_about("\n[tracking]\npyramid_level = 4\n"),
              AllOf(StartsWith(at_line(3)), HasSubstr("'pyramid_level'"),
                    HasSubstr("did you mean 'pyramid_levels'"), HasSubstr("lost_after_frames")));
}

TEST_F(ConfigFile, UnknownSectionNamesLineSectionAndNeighbour) {
  EXPECT_THAT(complaint_about("[trackin]\n"),
              AllOf(StartsWith(at_line(1)), HasSubstr("'trackin'"),
                    HasSubstr("did you mean 'tracking'"), HasSubstr("render")));
}

TEST_F(ConfigFile, KeyOutsideOfASectionIsRefused) {
  EXPECT_THAT(complaint_about("# a comment\nk = 40\n"),
              AllOf(StartsWith(at_line(2)), HasSubstr("'k'")));
}

TEST_F(ConfigFile, ValueInPlaceOfASectionIsRefused) {
  EXPECT_THAT(complaint_about("render = 40\n"),
              AllOf(StartsWith(at_line(1)), HasSubstr("expected [render]")));
}

TEST_F(ConfigFile, WrongTypeNamesLineKeyAndWhatIsAllowed) {
  for (const char* value : {"'forty'", "40.0", "true", "[40]", "{}", "2020-01-01"}) {
    EXPECT_THAT(complaint_about(std::string("[render]\nk = ") + value + "\n"),
                AllOf(StartsWith(at_line(2)), HasSubstr("render.k"),
                      HasSubstr("expected a whole number from 1 to 128 (perspectives)")))
        << value;
  }
  EXPECT_THAT(complaint_about("[log]\nlevel = 3\n"),
              AllOf(StartsWith(at_line(2)), HasSubstr("log.level"), HasSubstr("one of trace")));
}

TEST_F(ConfigFile, ValueOutOfRangeNamesLineKeyAndRange) {
  for (const char* value : {"0.999", "240.5", "nan", "-nan", "inf", "-inf", "1e300"}) {
    EXPECT_THAT(complaint_about(std::string("[loop]\n\nrate_hz = ") + value + "\n"),
                AllOf(StartsWith(at_line(3)), HasSubstr("loop.rate_hz"),
                      HasSubstr("expected a number from 1 to 240 (Hz)")))
        << value;
  }
}

TEST_F(ConfigFile, WholeNumberBeyondAnIntIsRefusedNotWrapped) {
  EXPECT_THAT(complaint_about("[render]\nk = 4294967336\n"), HasSubstr("4294967336"));
}

TEST_F(ConfigFile, UnknownWordIsRefusedWithTheWordsAllowed) {
  EXPECT_THAT(complaint_about("[log]\nlevel = 'loud'\n"),
              AllOf(StartsWith(at_line(2)), HasSubstr("\"loud\""),
                    HasSubstr("one of trace, debug, info, warn, error")));
}

TEST_F(ConfigFile, DuplicateKeyAndSectionAreRefusedAtTheirLine) {
  EXPECT_THAT(complaint_about("[render]\nk = 40\nk = 50\n"), StartsWith(at_line(3)));
  EXPECT_THAT(complaint_about("[render]\nk = 40\n[render]\nexponent = 2\n"),
              StartsWith(at_line(3)));
}

TEST_F(ConfigFile, SyntaxErrorNamesItsLine) {
  EXPECT_THAT(complaint_about("[render]\nk = 40\nexponent = = 2\n"), StartsWith(at_line(3)));
  EXPECT_THAT(complaint_about("[render\n"), StartsWith(at_line(1)));
  EXPECT_THAT(complaint_about(std::string("[render]\nk = \xff\xfe\n")), StartsWith(at_line(2)));
}

TEST_F(ConfigFile, MessageIsOneLine) {
  for (const char* text :
       {"[render]\nk = 40\nk = 50\n", "[render\n", "[log]\nlevel=\"a\\nb\"\n", "\"a\\nb\"=1\n"}) {
    EXPECT_THAT(complaint_about(text), AllOf(Not(""), Not(HasSubstr("\n")))) << text;
  }
}

TEST_F(ConfigFile, NamedFileMustExist) {
  const auto loading = [&] { load({.file = folder_ / "none.toml"}); };
  EXPECT_THAT(testing::message_of(loading), AllOf(HasSubstr("none.toml"), HasSubstr("no such")));
}

TEST_F(ConfigFile, FolderInPlaceOfAFileIsRefused) {
  const auto loading = [&] { load({.file = folder_.path()}); };
  EXPECT_THAT(testing::message_of(loading),
              StartsWith(folder_.path().string() + ": a folder, not a file"));
}

TEST_F(ConfigFile, FolderForCapturesNeedsAName) {
  EXPECT_THAT(complaint_about("[capture]\nfolder = ''\n"),
              AllOf(StartsWith(at_line(2)),
                    HasSubstr("capture.folder = \"\"; expected any text but an empty one")));
  EXPECT_EQ(load_text("[devices]\ncamera = ''\n").devices.camera, "");
}

TEST_F(ConfigFile, ThresholdsThatContradictEachOtherAreRefused) {
  EXPECT_THAT(complaint_about("[capture]\nthreshold_min_deg = 20\nthreshold_max_deg = 10\n"),
              AllOf(HasSubstr("threshold_min_deg"), HasSubstr("threshold_max_deg")));
}

// Default < system file < --config < --set: each source sets one key more than the one above it.
TEST_F(ConfigFile, LaterSourcesOverrideEarlierOnes) {
  const Sources sources{
      .system_file =
          folder_.write("system.toml", "[render]\nk = 41\nexponent = 3.0\n[loop]\nrate_hz = 20\n"),
      .file = folder_.write("own.toml", "[render]\nk = 42\nexponent = 4.0\n"),
      .assignments = {"render.k=43", "render.k=44"}};
  const Config config = load(sources);
  EXPECT_EQ(config.render.k, 44);
  EXPECT_EQ(config.render.exponent, 4.0);
  EXPECT_EQ(config.loop.rate_hz, 20.0);
  EXPECT_EQ(config.render.feather_px, Config{}.render.feather_px);
}

TEST_F(ConfigFile, ErrorInTheSystemFileNamesIt) {
  const Sources sources{.system_file = folder_.write("system.toml", "[render]\nkay = 41\n")};
  EXPECT_THAT(testing::message_of([&] { load(sources); }), HasSubstr("system.toml:2"));
}

}  // namespace
}  // namespace lumibox::config
