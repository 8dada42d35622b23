// The program as a stranger meets it: what it says and how it ends.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/recording.h"
#include "support/source_file.h"
#include "support/temp_dir.h"

namespace lumibox::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::read_text;
using testing::Recording;
using testing::TempDir;

struct Outcome {
  int status = -1;  ///< of exit; -1 if a signal ended it
  std::string out;
  std::string err;
};

/// Runs `lumibox` with these arguments, as a shell takes them.
Outcome lumibox(const std::string& arguments) {
  const TempDir dir;
  const std::string command = std::string(LUMIBOX_EXECUTABLE) + " " + arguments + " >" +
                              (dir / "out").string() + " 2>" + (dir / "err").string();
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(dir / "out"),
          read_text(dir / "err")};
}

/// Exit status 1 and one line that begins as all complaints do and holds these words.
#define EXPECT_COMPLAINT(outcome, words)                        \
  do {                                                          \
    const Outcome o = (outcome);                                \
    EXPECT_EQ(o.status, 1) << o.err;                            \
    EXPECT_THAT(o.err, AllOf(HasSubstr("lumibox: "), (words))); \
  } while (false)

TEST(CommandLine, EveryCommandExplainsItselfWithAnExample) {
  EXPECT_THAT(lumibox("--help").out, HasSubstr("COMMAND --help"));
  for (const std::string command :
       {"run", "demo", "track", "render", "evaluate", "import", "export", "sim"}) {
    const Outcome outcome = lumibox(command + " --help");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("Example:"), HasSubstr("lumibox " + command)));
  }
}

TEST(CommandLine, WrongUseExitsWithTwo) {
  for (const char* arguments :
       {"", "fly", "track", "track a b", "track walk --out t.tum --speed 3",
        "track walk --out t.tum --seed many", "demo --rate nan",
        "track walk --out t.tum --subject 1,2@3",
        "track walk --out t.tum --capture c --subject middle", "render c --views v --out o --k 0",
        "render c --views v --out o --mode huge", "export c --format gltf --out o"}) {
    const Outcome outcome = lumibox(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_FALSE(outcome.err.empty()) << arguments;
  }
}

TEST(CommandLine, MissingFilesAreNamed) {
  EXPECT_COMPLAINT(lumibox("track /nowhere/walk --out /tmp/t.tum"), HasSubstr("/nowhere/walk"));
  EXPECT_COMPLAINT(lumibox("sim /nowhere/scene.toml --out /nowhere/seq"),
                   HasSubstr("/nowhere/scene.toml"));
  EXPECT_COMPLAINT(lumibox("evaluate /nowhere/capture"), HasSubstr("/nowhere/capture"));
  EXPECT_COMPLAINT(lumibox("import /nowhere/transforms.json /nowhere/capture"),
                   HasSubstr("/nowhere/transforms.json"));
  EXPECT_COMPLAINT(lumibox("run --config /nowhere/box.toml"), HasSubstr("/nowhere/box.toml"));
}

TEST(CommandLine, BadSettingsAreNamed) {
  EXPECT_COMPLAINT(lumibox("run --set loop.rate_hz=fast"), HasSubstr("loop.rate_hz"));
  EXPECT_COMPLAINT(lumibox("evaluate c --set capture.nothing=1"), HasSubstr("capture.nothing"));
  const TempDir dir;
  const auto file = dir.write("box.toml", "[loop]\nrate_hz = -1\n");
  EXPECT_COMPLAINT(lumibox("run --config " + file.string()), HasSubstr(file.string() + ":2"));
}

TEST(CommandLine, WhatIsNotThereYetSaysSo) {
  EXPECT_COMPLAINT(lumibox("render c --views v --out o --geometry mesh"),
                   HasSubstr("not available yet: plane"));
  EXPECT_COMPLAINT(lumibox("export c --format web --out o"), HasSubstr("not available yet"));
}

TEST(CommandLine, FoldersThatHoldSomethingAreNotOverwritten) {
  const TempDir dir;
  dir.write("full/file", "precious");
  const std::string full = (dir / "full").string();
  const Recording recording;
  const std::string walk = recording.folder().string();
  EXPECT_COMPLAINT(lumibox("track " + walk + " --out " + full + ".tum --capture " + full),
                   HasSubstr(full));
  EXPECT_COMPLAINT(lumibox("import transforms.json " + full), HasSubstr(full));
  EXPECT_COMPLAINT(lumibox("export c --format colmap --out " + full), HasSubstr(full));
  EXPECT_COMPLAINT(lumibox("sim scene.toml --out " + full), HasSubstr(full));
  EXPECT_EQ(read_text(dir / "full" / "file"), "precious");
  EXPECT_COMPLAINT(lumibox("import transforms.json " + full + "/file"),
                   HasSubstr("is a file; expected an empty or absent folder"));
}

TEST(CommandLine, RecordingThatCannotBeTrackedLeavesItsStatisticsAndSaysWhy) {
  const Recording recording;
  const TempDir dir;
  const std::string out = (dir / "deep" / "walk").string();
  EXPECT_COMPLAINT(lumibox("track " + recording.folder().string() + " --out " + out +
                           ".tum --live " + out + ".live.tum --json " + out + ".json"),
                   HasSubstr("no frame could be tracked"));
  EXPECT_THAT(
      read_text(out + ".json"),
      AllOf(HasSubstr("\"frames\": 5"), HasSubstr("\"tracked\": 0"), HasSubstr("\"losses\": []")));
  EXPECT_TRUE(std::filesystem::exists(out + ".tum"));
  EXPECT_TRUE(std::filesystem::exists(out + ".live.tum"));
}

TEST(CommandLine, WhatCameBeforeABrokenPictureIsKept) {
  const Recording recording;
  recording.dir().write("rgb/000003.png", "not a picture");
  const std::string out = (recording.folder() / "walk").string();
  EXPECT_COMPLAINT(lumibox("track " + recording.folder().string() + " --out " + out +
                           ".tum --json " + out + ".json"),
                   HasSubstr("000003.png"));
  EXPECT_THAT(read_text(out + ".json"), HasSubstr("\"frames\": 3"));
  EXPECT_TRUE(std::filesystem::exists(out + ".tum"));
}

TEST(CommandLine, PlacesForResultsAreTriedBeforeTheWork) {
  const Recording recording;
  const TempDir dir;
  dir.write("file", "in the way");
  const std::string bad = (dir / "file" / "stats.json").string();
  const std::string out = (dir / "walk.tum").string();
  EXPECT_COMPLAINT(
      lumibox("track " + recording.folder().string() + " --out " + out + " --json " + bad),
      HasSubstr((dir / "file").string()));
  EXPECT_FALSE(std::filesystem::exists(out)) << "nothing was tracked, and the trial left nothing";
  EXPECT_COMPLAINT(lumibox("evaluate /nowhere/capture --json " + dir.path().string()),
                   HasSubstr(dir.path().string() + ": cannot be written: Is a directory"));
}

TEST(CommandLine, AnErrorWithOneResultDoesNotCostTheOthers) {
  const Recording recording;
  const TempDir dir;
  EXPECT_COMPLAINT(lumibox("track " + recording.folder().string() + " --out /dev/full --json " +
                           (dir / "stats.json").string()),
                   HasSubstr("/dev/full"));
  EXPECT_THAT(read_text(dir / "stats.json"), HasSubstr("\"frames\": 5"));
}

struct Spoiled {
  const char* name;     ///< of the case
  const char* file;     ///< within the recording
  const char* content;  ///< null: the file is removed
};

class BadRecording : public ::testing::TestWithParam<Spoiled> {};

TEST_P(BadRecording, IsRefusedWithTheNameOfTheFile) {
  const Recording recording;
  const auto file = recording.folder() / GetParam().file;
  if (GetParam().content == nullptr) {
    std::filesystem::remove(file);
  } else {
    recording.dir().write(GetParam().file, GetParam().content);
  }
  const std::string out = (recording.folder() / "out.tum").string();
  EXPECT_COMPLAINT(lumibox("track " + recording.folder().string() + " --out " + out),
                   HasSubstr(file.string()));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadRecording,
    ::testing::Values(Spoiled{"MissingPicture", "rgb/000003.png", nullptr},
                      Spoiled{"TextForAPicture", "rgb/000003.png", "not a picture"},
                      Spoiled{"TruncatedPng", "rgb/000003.png", "\x89PNG\r\n\x1a\n"},
                      Spoiled{"EmptyList", "rgb.txt", "# nothing\n"},
                      Spoiled{"NanInCalibration", "calib.txt", "nan 30 16 12 0 0 0 0 32 24 10\n"},
                      Spoiled{"ZeroFocalLength", "calib.txt", "0 30 16 12 0 0 0 0 32 24 10\n"},
                      Spoiled{"TooFewNumbers", "calib.txt", "30 30 16 12\n"}),
    [](const auto& spoiled) { return spoiled.param.name; });

}  // namespace
}  // namespace lumibox::app
