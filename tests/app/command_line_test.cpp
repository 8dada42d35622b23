// The program as a stranger meets it: what it says and how it ends.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include "hal/image_io.h"
#include "support/other_process.h"
#include "support/recording.h"
#include "support/service_manager.h"
#include "support/small_scene.h"
#include "support/source_file.h"
#include "support/temp_dir.h"

namespace lumibox::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::read_text;
using testing::Recording;
using ::testing::StartsWith;
using ::testing::StrEq;
using testing::TempDir;

struct Outcome {
  int status = -1;  ///< of exit; -1 if a signal ended it
  std::string out;
  std::string err;
};

/// Runs `lumibox` with these arguments, as a shell takes them, its output into a file of its own or
/// that named.
Outcome lumibox(const std::string& arguments, const std::string& output = {}) {
  const TempDir dir;
  const std::string command = std::string(LUMIBOX_EXECUTABLE) + " " + arguments + " >" +
                              (output.empty() ? (dir / "out").string() : output) + " 2>" +
                              (dir / "err").string();
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(dir / "out"),
          read_text(dir / "err")};
}

/// Exit status 1 and one line that begins as all complaints do and holds these words.
#define EXPECT_COMPLAINT(outcome, words)                         \
  do {                                                           \
    const Outcome o = (outcome);                                 \
    EXPECT_EQ(o.status, 1) << o.err;                             \
    EXPECT_THAT(o.err, AllOf(StartsWith("lumibox: "), (words))); \
    EXPECT_EQ(std::ranges::count(o.err, '\n'), 1) << o.err;      \
  } while (false)

/// A capture of two pictures of the recording; its path.
std::string small_capture(const Recording& recording) {
  const auto frame = [](const char* file, const char* x) {
    return std::string("{\"file_path\":\"") + file + "\",\"transform_matrix\":[[1,0,0," + x +
           "],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}";
  };
  const auto file = recording.dir().write(
      "transforms.json", "{\"fl_x\":30,\"frames\":[" + frame("rgb/000000.png", "0") + "," +
                             frame("rgb/000001.png", "0.1") + "]}");
  const std::string capture = (recording.folder() / "capture").string();
  const Outcome outcome = lumibox("import " + file.string() + " " + capture);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("2 perspectives and 0 points in"));
  EXPECT_THAT(outcome.err, HasSubstr("no points could be found"));  // two pictures are too few
  return capture;
}

TEST(CommandLine, EveryCommandExplainsItselfWithAnExample) {
  EXPECT_THAT(lumibox("--help").out, HasSubstr("COMMAND --help"));
  for (const std::string command : {"run", "cameras", "demo", "track", "render", "evaluate",
                                    "import", "export", "calibrate", "sim", "bench"}) {
    const Outcome outcome = lumibox(command + " --help");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("Example:"), HasSubstr("lumibox " + command)));
  }
}

TEST(CommandLine, WrongUseExitsWithTwo) {
  for (const char* arguments : {"",
                                "fly",
                                "track",
                                "track a b",
                                "track walk --out t.tum --speed 3",
                                "track walk --out t.tum --seed many",
                                "track walk --out t.tum --seed 4294967296",
                                "sim s.toml --out ''",
                                "sim --out s",
                                "sim s.toml --random 1 --out s",
                                "sim s.toml --walk arc --out s",
                                "sim --random 1 --walk swim --out s",
                                "sim --random 1 --effects rolling_shutter,fog --out s",
                                "sim --random -1 --out s",
                                "import '' c",
                                "render c --views v --out o --calib ''",
                                "demo --rate nan",
                                "track walk --out t.tum --subject 1,2@3",
                                "track walk --out t.tum --capture c --subject middle",
                                "render c --views v --out o --k 0",
                                "render c --views v --out o --mode huge",
                                "export c --format gltf --out o",
                                "bench tracking",
                                "bench tracking --out o --random 8",
                                "bench tracking --out o --random 8-1",
                                "bench tracking --out o --random 1-8x",
                                "bench tracking --out o --runs 0",
                                "bench rendering --out o --views 0"}) {
    const Outcome outcome = lumibox(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_FALSE(outcome.err.empty()) << arguments;
  }
}

/// A run without a screen, whose captures go into the folder.
std::string run_on(const std::string& camera, const std::string& display, const TempDir& dir) {
  return "run --set devices.camera=" + camera + " --set devices.display=" + display +
         " --set capture.folder=" + (dir / "captures").string();
}

TEST(CommandLine, TheServiceManagerIsToldOfAnEndThatIsAnError) {
  const Recording recording;
  const TempDir dir;
  const testing::ServiceManager manager((dir / "notify").string());
  recording.dir().write(Recording::name(3), "no picture");
  EXPECT_COMPLAINT(lumibox(run_on("replay:" + recording.folder().string(), "offscreen:64x48", dir) +
                           " --set devices.clock=virtual"),
                   HasSubstr(Recording::name(3)));
  EXPECT_THAT(manager.heard(), AllOf(HasSubstr("READY=1"), HasSubstr("STOPPING=1")));
}

// As long as it takes; the service manager must not think that the start failed.
TEST(CommandLine, ABoxWithoutItsCameraOrItsScreenIsReadyAndWaits) {
  const Recording recording;
  const std::string replay = "replay:" + recording.folder().string();
  for (const auto& [camera, display] : {std::pair("v4l2:/nowhere/video", "offscreen:64x48"),
                                        std::pair(replay.c_str(), "kms:/nowhere/card0")}) {
    const TempDir dir;
    const testing::ServiceManager manager((dir / "notify").string());
    const std::string pid = (dir / "pid").string();
    const std::string command = std::string(LUMIBOX_EXECUTABLE) + " " +
                                run_on(camera, display, dir) + " >" + (dir / "log").string() +
                                " 2>&1" + " & echo $! >" + pid;
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_THAT(manager.heard_until("READY=1"), HasSubstr("STATUS=no ")) << camera;
    kill(std::stoi(read_text(pid)), SIGTERM);
    EXPECT_THAT(manager.heard_until("STOPPING=1"), HasSubstr("STOPPING=1")) << camera;
    EXPECT_THAT(read_text(dir / "log"), HasSubstr("waiting: ")) << camera;
  }
}

TEST(CommandLine, MissingFilesAreNamed) {
  EXPECT_COMPLAINT(lumibox("track /nowhere/walk --out /tmp/t.tum"), HasSubstr("/nowhere/walk"));
  EXPECT_COMPLAINT(lumibox("sim /nowhere/scene.toml --out /nowhere/seq"),
                   HasSubstr("/nowhere/scene.toml"));
  EXPECT_COMPLAINT(lumibox("bench tracking --out /tmp --sequence /nowhere/walk"),
                   HasSubstr("/nowhere/walk"));
  EXPECT_COMPLAINT(lumibox("bench rendering --out /tmp --scene /nowhere/scene.toml"),
                   HasSubstr("/nowhere/scene.toml"));
  EXPECT_COMPLAINT(lumibox("evaluate /nowhere/capture"), HasSubstr("/nowhere/capture"));
  EXPECT_COMPLAINT(lumibox("import /nowhere/transforms.json /nowhere/capture"),
                   HasSubstr("/nowhere/transforms.json"));
  EXPECT_COMPLAINT(lumibox("run --config /nowhere/box.toml"), HasSubstr("/nowhere/box.toml"));
}

TEST(CommandLine, RandomSceneThatCannotBeIsRefused) {
  EXPECT_COMPLAINT(lumibox("sim --walk orbit --random 1 --place facade --out /nowhere/seq"),
                   HasSubstr("a facade cannot be walked around"));
  EXPECT_COMPLAINT(
      lumibox("sim --effects vignetting,refraction --place facade --random 1 --out /nowhere/seq"),
      HasSubstr("refraction"));
}

TEST(CommandLine, BadSettingsAreNamed) {
  EXPECT_COMPLAINT(lumibox("run --set loop.rate_hz=fast"), HasSubstr("loop.rate_hz"));
  EXPECT_COMPLAINT(lumibox("evaluate c --set capture.nothing=1"), HasSubstr("capture.nothing"));
  const TempDir dir;
  const auto file = dir.write("box.toml", "[loop]\nrate_hz = -1\n");
  EXPECT_COMPLAINT(lumibox("run --config " + file.string()), HasSubstr(file.string() + ":2"));
}

TEST(CommandLine, OptionsHaveTheRangesOfTheSettingsTheyStandFor) {
  EXPECT_EQ(lumibox("render c --views v --out o --exponent 80").status, 2);
  EXPECT_COMPLAINT(lumibox("evaluate c --set render.exponent=80"), HasSubstr("render.exponent"));
  EXPECT_COMPLAINT(lumibox("render c --views v --out o --exponent 64"),
                   HasSubstr("c: is not a folder"));
}

TEST(CommandLine, OffersOnlyWhatItHas) {
  const Outcome geometry = lumibox("render c --views v --out o --geometry cube");
  EXPECT_EQ(geometry.status, 2);
  EXPECT_THAT(geometry.err,
              AllOf(HasSubstr("--geometry"), HasSubstr("cube not in {plane,focal,mesh}")));
  const Outcome bench = lumibox("bench cooking --out o");
  EXPECT_EQ(bench.status, 2);
  EXPECT_THAT(bench.err, HasSubstr("cooking not in {tracking,rendering,simulation}"));
  const Outcome format = lumibox("export c --format web --out o");
  EXPECT_EQ(format.status, 2);
  EXPECT_THAT(format.err, AllOf(HasSubstr("--format"), HasSubstr("web not in {")));
}

TEST(CommandLine, NamesTheCommandThatThereIsNot) {
  EXPECT_THAT(lumibox("fly").err,
              AllOf(HasSubstr("fly"), HasSubstr("expected run, cameras, demo, track")));
  EXPECT_THAT(lumibox("--fly").err, HasSubstr("--fly"));
  EXPECT_THAT(lumibox("").err, HasSubstr("expected run, cameras, demo, track"));
}

/// A calibration of these pictures, with a profile that must not be touched.
class CalibrateCommand : public ::testing::Test {
 protected:
  Outcome calibrate(const std::string& arguments) const {
    return lumibox("calibrate " + arguments + " --square 0.025 --out " + out_.string());
  }
  std::string picture(int width, int height, const std::string& name) const {
    hal::write_png(dir_ / name, hal::Image(width, height, 1));
    return (dir_ / name).string() + " ";
  }
  TempDir dir_;
  std::filesystem::path out_ = dir_.write("camera.toml", "as before");
};

TEST_F(CalibrateCommand, RefusesPicturesWithoutABoardAndLeavesTheProfile) {
  EXPECT_COMPLAINT(calibrate(picture(64, 48, "a.png") + "--board 9x6"),
                   HasSubstr("no board of 9x6 inner corners in any of 1 pictures"));
  EXPECT_EQ(read_text(out_), "as before");
}

TEST_F(CalibrateCommand, RefusesPicturesOfDifferentSizes) {
  EXPECT_COMPLAINT(calibrate(picture(64, 48, "a.png") + picture(48, 64, "b.png") + "--board 9x6"),
                   AllOf(HasSubstr("b.png"), HasSubstr("48x64"), HasSubstr("expected 64x48")));
}

TEST_F(CalibrateCommand, RefusesOddBoards) {
  const std::string image = picture(64, 48, "a.png");
  EXPECT_COMPLAINT(calibrate(image + "--board 2x6"), HasSubstr("2x6 inner corners; expected 3"));
  EXPECT_COMPLAINT(calibrate(image + "--board 9x6 --charuco DICT_1 --marker 0.01"),
                   HasSubstr("no marker dictionary DICT_1"));
  EXPECT_EQ(calibrate(image + "--board 9by6").status, 2);
  EXPECT_EQ(calibrate(image + "--board 9x6 --charuco DICT_4X4_50").status, 2);
}

TEST_F(CalibrateCommand, RefusesAProfileThatNobodyWouldReadAsOne) {
  EXPECT_COMPLAINT(lumibox("calibrate a.png --board 9x6 --square 0.025 --out a.png"),
                   HasSubstr("expected a name in .toml"));
}

TEST(CommandLine, SubjectInAFrameThatIsNotThereIsRefused) {
  const Recording recording;
  const std::string walk = recording.folder().string();
  EXPECT_COMPLAINT(lumibox("track " + walk + " --out " + walk + "/o.tum --capture " + walk +
                           "/c --subject 16,12@5"),
                   HasSubstr("--subject: frame 5; the recording has 5, from 0"));
}

TEST(CommandLine, GoingOnNeedsTheMapOfACapture) {
  const Recording recording;
  const std::string capture = small_capture(recording);
  const std::string track =
      "track " + recording.folder().string() + " --out " + capture + ".tum --resume ";
  EXPECT_COMPLAINT(lumibox(track + "/nowhere"), HasSubstr("/nowhere: is not a folder"));
  EXPECT_COMPLAINT(lumibox(track + capture), HasSubstr(capture + "/map/map.json"));
  recording.dir().write("capture/map/map.json", "{\"version\": 9}");
  EXPECT_COMPLAINT(lumibox(track + capture + " --capture " + capture),
                   HasSubstr("map.json: version is 9, expected"));
  EXPECT_EQ(lumibox("evaluate " + capture).status, 0) << "it can be looked at all the same";
}

TEST(CommandLine, ACaptureThatAnotherProcessRecordsToIsLeftAlone) {
  const Recording recording;
  const std::string capture = small_capture(recording);
  std::filesystem::create_directory(capture + "_new");
  const testing::FolderOfAnother other(capture);
  const testing::FolderOfAnother other_new(capture + "_new");
  const auto before = testing::files_in(capture);
  const std::string track =
      "track " + recording.folder().string() + " --out " + capture + ".tum --capture ";
  EXPECT_COMPLAINT(lumibox(track + capture + " --resume " + capture),
                   HasSubstr(capture + ": is being recorded to by another process"));
  EXPECT_COMPLAINT(lumibox(track + capture + "_new"),
                   HasSubstr(capture + "_new: is being recorded to by another process"));
  EXPECT_EQ(testing::files_in(capture), before);
  EXPECT_EQ(lumibox("evaluate " + capture).status, 0) << "it can be looked at meanwhile";
}

TEST(CommandLine, ViewsWithoutPosesAreRefused) {
  const Recording recording;
  const std::string capture = small_capture(recording);
  const auto views = recording.dir().write("views.tum", "# none yet\n");
  EXPECT_COMPLAINT(
      lumibox("render " + capture + " --views " + views.string() + " --out " + capture + "_out"),
      AllOf(HasSubstr(views.string()), HasSubstr("holds no poses; expected lines `t tx")));
  EXPECT_FALSE(std::filesystem::exists(capture + "_out"));
}

TEST(CommandLine, CaptureWithoutASubjectIsToldAsSuch) {
  const Recording recording;
  const std::string capture = small_capture(recording);
  const auto views = recording.dir().write("views.tum", "0 0 0 0 0 0 0 1\n");
  std::string text = read_text(capture + "/transforms.json");
  text.replace(text.find("\"subject\""), 9, "\"nothing\"");
  recording.dir().write("capture/transforms.json", text);
  EXPECT_COMPLAINT(lumibox("evaluate " + capture), HasSubstr("names no subject"));
  EXPECT_COMPLAINT(
      lumibox("render " + capture + " --views " + views.string() + " --out " + capture + "_out"),
      HasSubstr("names no subject"));
}

TEST(CommandLine, ResultsDoNotOverwriteTheCapture) {
  const Recording recording;
  const std::string capture = small_capture(recording);
  recording.dir().write("capture/map/map.json", "the map");
  std::filesystem::create_directory_symlink(capture + "/map", recording.folder() / "link");
  std::filesystem::create_symlink(capture + "/map/new.json", recording.folder() / "dangling");
  const auto views = recording.dir().write("views.tum", "0 0 0 0 0 0 0 1\n");
  const auto before = testing::files_in(capture);
  const std::string folder = recording.folder().string();
  for (const std::string out : {"capture/images", "capture/images/sub", "capture/map", "link",
                                "capture/images/../map/deep/down"}) {
    EXPECT_COMPLAINT(lumibox("render " + capture + "/ --views " + views.string() + " --out " +
                             folder + "/" + out),
                     HasSubstr(folder + "/" + out + ": belongs to the capture"));
  }
  for (const std::string json : {"capture/transforms.json", "capture/images/000000.png",
                                 "capture/map/map.json", "capture/points.ply", "dangling"}) {
    EXPECT_COMPLAINT(lumibox("evaluate " + capture + " --json " + folder + "/" + json),
                     HasSubstr(folder + "/" + json + ": belongs to the capture"));
  }
  for (const std::string pictures : {"capture/../capture/images/", "capture/map"}) {
    EXPECT_COMPLAINT(lumibox("evaluate " + capture + " --pictures " + folder + "/" + pictures),
                     HasSubstr("belongs to the capture"));
  }
  EXPECT_COMPLAINT(
      lumibox("export " + capture + " --format colmap --out " + capture + "/images/colmap"),
      HasSubstr("belongs to the capture"));
  EXPECT_EQ(testing::files_in(capture), before);
  EXPECT_EQ(lumibox("evaluate " + capture + " --json " + capture + "/quality.json").status, 0)
      << "a new name beside what is recorded is free";
}

TEST(CommandLine, ResultsOfTrackingDoNotOverwriteCaptures) {
  const Recording recording;
  const std::string capture = small_capture(recording);
  const auto before = testing::files_in(recording.folder());
  const std::string folder = recording.folder().string() + "/";
  const std::string track = "track " + folder + " --out ";
  EXPECT_COMPLAINT(lumibox(track + capture + "/transforms.json"),
                   HasSubstr("transforms.json: belongs to the capture in " + capture));
  EXPECT_COMPLAINT(lumibox(track + folder + "t.tum --plot " + capture + "/images/000000.png"),
                   HasSubstr("000000.png: belongs to the capture in " + capture));
  EXPECT_COMPLAINT(lumibox(track + folder + "new/transforms.json --capture " + folder + "new"),
                   HasSubstr("lies in the capture in " + folder + "new"));
  EXPECT_COMPLAINT(lumibox(track + folder + "new --capture " + folder + "new"),
                   HasSubstr("lies in the capture in " + folder + "new"));
  EXPECT_COMPLAINT(
      lumibox(track + folder + "t.tum --live " + capture + "/t.tum --resume " + capture),
      HasSubstr("lies in the capture in " + capture));
  EXPECT_COMPLAINT(lumibox(track + folder + "t.tum --capture " + capture + "/images/new"),
                   HasSubstr("belongs to the capture in " + capture));
  EXPECT_EQ(testing::files_in(recording.folder()), before);
}

TEST(CommandLine, ResultsOfTrackingDoNotOverwriteTheRecording) {
  const Recording recording;
  const std::string folder = recording.folder().string() + "/";
  std::filesystem::create_hard_link(folder + "rgb/000002.png", folder + "same.png");
  std::filesystem::create_symlink("rgb.txt", folder + "link");
  std::filesystem::remove(folder + "groundtruth.txt");
  const auto before = testing::files_in(recording.folder());
  const std::string track = "track " + folder + " --out ";
  for (const std::string result : {"rgb.txt", "link", "calib.txt", "subject.txt", "rgb/000003.png",
                                   "same.png", "groundtruth.txt", "rgb.mp4"}) {
    EXPECT_COMPLAINT(lumibox(track + folder + result),
                     HasSubstr(folder + result + ": belongs to the recording in " + folder));
    EXPECT_COMPLAINT(lumibox(track + folder + "t.tum --json " + folder + result),
                     HasSubstr(folder + result + ": belongs to the recording in " + folder));
  }
  EXPECT_EQ(testing::files_in(recording.folder()), before);
}

// The libraries that read videos have words of their own for what is wrong.
TEST(CommandLine, BrokenVideoIsOneLine) {
  const TempDir dir;
  const auto video = dir.write("walk.mp4", "not a video");
  EXPECT_COMPLAINT(lumibox("track " + video.string() + " --out " + (dir / "o.tum").string()),
                   HasSubstr(video.string()));
}

TEST(CommandLine, FileInPlaceOfTheFolderToBeMadeIsNamedAsSuch) {
  EXPECT_COMPLAINT(lumibox("import x /dev/full"), HasSubstr("/dev/full: is a file; expected"));
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
  EXPECT_COMPLAINT(
      lumibox("track " + recording.folder().string() + " --out " + out + ".tum --live " + out +
              ".live.tum --json " + out + ".json --plot " + out + ".svg"),
      HasSubstr("no frame could be tracked"));
  EXPECT_THAT(
      read_text(out + ".json"),
      AllOf(HasSubstr("\"frames\": 5"), HasSubstr("\"tracked\": 0"), HasSubstr("\"losses\": []")));
  EXPECT_TRUE(std::filesystem::exists(out + ".tum"));
  EXPECT_TRUE(std::filesystem::exists(out + ".live.tum"));
  EXPECT_THAT(read_text(out + ".svg"), HasSubstr("5 frames, 0 tracked"));
}

TEST(CommandLine, TruthWithoutPosesIsWarnedOf) {
  const Recording recording;
  recording.dir().write("groundtruth.txt", "# nothing\n");
  const std::string out = (recording.folder() / "walk.tum").string();
  EXPECT_THAT(lumibox("track " + recording.folder().string() + " --out " + out).err,
              HasSubstr("groundtruth.txt: no poses"));
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
  EXPECT_COMPLAINT(
      lumibox("track " + recording.folder().string() + " --out " + out + " --plot " + bad),
      HasSubstr((dir / "file").string()));
  EXPECT_FALSE(std::filesystem::exists(out)) << "nothing was tracked, and the trial left nothing";
  EXPECT_COMPLAINT(lumibox("evaluate /nowhere/capture --json " + dir.path().string()),
                   HasSubstr(dir.path().string() + ": cannot be written: Is a directory"));
}

TEST(CommandLine, TwoResultsAreNotOneFile) {
  const Recording recording;
  const TempDir dir;
  const std::string out = (dir / "out.tum").string();
  const std::string again = (dir / "." / "out.tum").string();
  for (const char* option : {" --live ", " --json ", " --plot "}) {
    EXPECT_COMPLAINT(
        lumibox("track " + recording.folder().string() + " --out " + out + option + again),
        HasSubstr(again + ": named for two results"));
  }
}

TEST(CommandLine, OutputThatGoesNowhereIsAnError) {
  EXPECT_COMPLAINT(lumibox("--version", "/dev/full"), HasSubstr("standard output"));
}

TEST(CommandLine, BenchTriesItsPlaceBeforeTheWork) {
  const TempDir dir;
  dir.write("file", "in the way");
  EXPECT_COMPLAINT(lumibox("bench tracking --out " + (dir / "file").string()),
                   HasSubstr((dir / "file").string()));
}

TEST(CommandLine, BenchOfTheRendererWritesMeasurementsAndAPlot) {
  const TempDir dir;
  const auto scene = dir.write("ball.toml", testing::kSmallScene);
  const Outcome outcome = lumibox("bench rendering --views 1 --perspectives 6 --out " +
                                  (dir / "out").string() + " --scene " + scene.string());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("naive quads / plane-small"), HasSubstr("default"),
                                 HasSubstr("knee"), HasSubstr("ball: on the subject")));
  const std::string lines = read_text(dir / "out" / "rendering.jsonl");
  for (const char* what : {"quality", "speed", "ratio", "memory"}) {
    EXPECT_THAT(lines, HasSubstr(std::string("\"what\":\"rendering_") + what + "\"")) << what;
  }
  EXPECT_THAT(read_text(dir / "out" / "rendering.svg"),
              AllOf(HasSubstr("</svg>"), HasSubstr(">ball<"), HasSubstr("mesh: threshold")));
}

TEST(CommandLine, AnErrorWithOneResultDoesNotCostTheOthers) {
  const Recording recording;
  const TempDir dir;
  EXPECT_COMPLAINT(lumibox("track " + recording.folder().string() + " --out /dev/full --json " +
                           (dir / "stats.json").string()),
                   HasSubstr("/dev/full"));
  EXPECT_THAT(read_text(dir / "stats.json"), HasSubstr("\"frames\": 5"));
}

TEST(CommandLine, AllThatWentWrongIsOneLine) {
  const Recording recording;
  const std::string full = "/dev/full: cannot be written: No space left on device";
  EXPECT_COMPLAINT(lumibox("track " + recording.folder().string() +
                           " --out /dev/full --json /dev/full --plot /dev/full"),
                   StrEq("lumibox: " + full + "; " + full + "; " + full + "\n"));
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
