#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/image_io.h"
#include "hal/replay/replay_camera.h"
#include "hal/sim/virtual_clock.h"
#include "support/input_error.h"
#include "support/recording.h"
#include "support/source_file.h"

// Recordings come from anywhere: whatever is wrong with one is said in a line that names the file.
namespace lumibox::hal {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::Recording;

/// What is said of a recording when it is opened and played to its end.
std::string complaint_about(const fs::path& path) {
  return testing::message_of([&] {
    const VirtualClock clock;
    ReplayCamera camera(open_sequence(path), clock, Pacing::Lockstep);
    camera.start();
    while (camera.take_newest()) {
    }
  });
}

class BadSequence : public ::testing::Test {
 protected:
  std::string complaint() const { return complaint_about(recording_.folder()); }

  void replace(const std::string& file, const std::string& content) const {
    recording_.dir().write(file, content);
  }
  /// Line `line` (from 1) of a file becomes `text`.
  void replace_line(const std::string& file, int line, const std::string& text) const {
    std::istringstream before(testing::read_text(recording_.folder() / file));
    std::string after;
    int number = 1;
    for (std::string old; std::getline(before, old); ++number) {
      after += (number == line ? text : old) + "\n";
    }
    replace(file, after);
  }

  const Recording recording_;
};

TEST_F(BadSequence, IsGoodBeforeItIsSpoiled) {
  EXPECT_EQ(complaint(), "");
}

TEST_F(BadSequence, MissingFolder) {
  EXPECT_THAT(complaint_about("/no/such/recording"),
              AllOf(HasSubstr("/no/such/recording"), HasSubstr("no such")));
}

TEST_F(BadSequence, TextInPlaceOfAVideo) {
  EXPECT_THAT(complaint_about(recording_.folder() / "calib.txt"),
              AllOf(HasSubstr("calib.txt"), HasSubstr("video")));
}

TEST_F(BadSequence, MissingImage) {
  fs::remove(recording_.folder() / Recording::name(3));
  EXPECT_THAT(complaint(), AllOf(HasSubstr("rgb.txt:5"), HasSubstr("rgb/000003.png")));
}

TEST_F(BadSequence, FolderInPlaceOfAnImage) {
  replace_line("rgb.txt", 3, "5.1 rgb");
  EXPECT_THAT(complaint(), HasSubstr("rgb.txt:3"));
}

TEST_F(BadSequence, LineWithoutAName) {
  replace_line("rgb.txt", 3, "5.1");
  EXPECT_THAT(complaint(), HasSubstr("rgb.txt:3"));
}

TEST_F(BadSequence, TruncatedPng) {
  const fs::path file = recording_.folder() / Recording::name(2);
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_THAT(complaint(), AllOf(HasSubstr("rgb/000002.png"), HasSubstr("damaged PNG")));
}

TEST_F(BadSequence, TruncatedJpeg) {
  const std::vector<std::uint8_t> jpeg = encode_jpeg(Recording::picture(2), 90);
  replace(Recording::name(2), std::string(jpeg.begin(), jpeg.begin() + 500));
  ASSERT_GT(jpeg.size(), 600U);
  EXPECT_THAT(complaint(), AllOf(HasSubstr("rgb/000002.png"), HasSubstr("damaged JPEG")));
}

TEST_F(BadSequence, TextInPlaceOfAnImage) {
  for (const int frame : {0, 2}) {
    replace(Recording::name(frame), "a picture of a cat\n");
    EXPECT_THAT(complaint(), AllOf(HasSubstr(Recording::name(frame)), HasSubstr("not an image")));
    write_png(recording_.folder() / Recording::name(frame), Recording::picture(frame));
  }
}

TEST_F(BadSequence, EmptyImage) {
  replace(Recording::name(1), "");
  EXPECT_THAT(complaint(), AllOf(HasSubstr("rgb/000001.png"), HasSubstr("empty")));
}

TEST_F(BadSequence, NotFiniteNumbers) {
  for (const char* number : {"nan", "inf", "-inf", "NaN", "1e999", "one", "1,5", "0x10"}) {
    replace_line("rgb.txt", 3, std::string(number) + " rgb/000001.png");
    EXPECT_THAT(complaint(), HasSubstr("rgb.txt:3")) << number;
    replace_line("rgb.txt", 3, "5.1 rgb/000001.png");

    replace_line("groundtruth.txt", 4, std::string("5.2 ") + number + " 0 0 0 0 0 1");
    EXPECT_THAT(complaint(), HasSubstr("groundtruth.txt:4")) << number;
    replace_line("groundtruth.txt", 4, "5.2 0 0 0 0 0 0 1");

    for (int column = 0; column < 13; ++column) {
      std::string calibration;
      for (int i = 0; i < 13; ++i) {
        const char* const good[] = {"30", "30", "15", "11", "0", "0", "0",
                                    "0",  "32", "24", "10", "0", "0"};
        calibration += std::string(i == column ? number : good[i]) + " ";
      }
      replace("calib.txt", calibration + "\n");
      EXPECT_THAT(complaint(), HasSubstr("calib.txt:1")) << number << " in column " << column;
    }
    replace("calib.txt", "30 30 15 11 0 0 0 0 32 24 10\n");

    replace("subject.txt", std::string("0 0 0 ") + number + "\n");
    EXPECT_THAT(complaint(), HasSubstr("subject.txt:1")) << number;
    replace("subject.txt", "0 0 0 1\n");
  }
  EXPECT_EQ(complaint(), "");
}

TEST_F(BadSequence, FocalLengthOfZeroOrLess) {
  for (const char* focal : {"0 30", "30 0", "-30 30", "30 -30"}) {
    replace("calib.txt", std::string(focal) + " 15 11 0 0 0 0 32 24 10\n");
    EXPECT_THAT(complaint(), AllOf(HasSubstr("calib.txt:1"), HasSubstr("expected"))) << focal;
  }
}

TEST_F(BadSequence, TooFewAndTooManyNumbersInCalibration) {
  for (const char* text :
       {"30 30 15 11 0 0 0 0 32 24\n", "30\n", "30 30 15 11 0 0 0 0 32 24 10 0 0 0\n"}) {
    replace("calib.txt", text);
    EXPECT_THAT(complaint(), AllOf(HasSubstr("calib.txt:1"), HasSubstr("fx fy cx cy"))) << text;
  }
}

TEST_F(BadSequence, EmptyAndMissingCalibration) {
  replace("calib.txt", "# nothing\n");
  EXPECT_THAT(complaint(), HasSubstr("calib.txt"));
  fs::remove(recording_.folder() / "calib.txt");
  EXPECT_THAT(complaint(), AllOf(HasSubstr("calib.txt"), HasSubstr("no such file")));
}

TEST_F(BadSequence, SizesThatAreNotWholeOrNotPositive) {
  for (const char* size : {"32.5 24", "32 -24", "0 24", "32 1e9", "99999999999 24"}) {
    replace("calib.txt", std::string("30 30 15 11 0 0 0 0 ") + size + " 10\n");
    EXPECT_THAT(complaint(), HasSubstr("calib.txt:1")) << size;
  }
}

TEST_F(BadSequence, PrincipalPointFarOutside) {
  replace("calib.txt", "30 30 15 1100 0 0 0 0 32 24 10\n");
  EXPECT_THAT(complaint(), AllOf(HasSubstr("calib.txt:1"), HasSubstr("cy is 1100")));
}

// Else the tracking would complain about the pictures.
TEST_F(BadSequence, LensThatFoldsInsideThePicture) {
  const std::string words = "turns back before pixel 0, 0; expected";
  replace("calib.txt", "# a comment\n30 30 15 11 -3 0 0 0 32 24 10\n");
  EXPECT_THAT(complaint(), AllOf(HasSubstr("calib.txt:2"), HasSubstr(words)));
  const auto profile = recording_.dir().write(
      "lens.toml", "width = 32\nheight = 24\nfx = 30\nfy = 30\ncx = 15\ncy = 11\nk1 = -3\n");
  EXPECT_THAT(testing::message_of([&] { open_sequence(recording_.folder(), profile); }),
              AllOf(HasSubstr("lens.toml"), HasSubstr(words)));
}

TEST_F(BadSequence, EmptyImageList) {
  for (const char* text : {"", "# timestamp filename\n", "\n\n"}) {
    replace("rgb.txt", text);
    EXPECT_THAT(complaint(), AllOf(HasSubstr("rgb.txt"), HasSubstr("names no images")));
  }
}

TEST_F(BadSequence, TimesThatGoBackOrStandStill) {
  for (const char* time : {"5.0", "4.9", "-5"}) {
    replace_line("rgb.txt", 3, std::string(time) + " rgb/000001.png");
    EXPECT_THAT(complaint(), AllOf(HasSubstr("rgb.txt:3"), HasSubstr("increasing"))) << time;
  }
  replace_line("rgb.txt", 3, "5.1 rgb/000001.png");
  replace_line("groundtruth.txt", 4, "5.05 0 0 0 0 0 0 1");
  EXPECT_THAT(complaint(), AllOf(HasSubstr("groundtruth.txt:4"), HasSubstr("increasing")));
}

TEST_F(BadSequence, PathThatLeavesTheFolder) {
  const testing::TempDir elsewhere;
  const fs::path secret = elsewhere / "secret.png";
  write_png(secret, Recording::picture(0));
  const fs::path climbing = fs::relative(secret, recording_.folder());
  for (const fs::path& name : {climbing, secret, "rgb" / (".." / climbing)}) {
    replace_line("rgb.txt", 3, "5.1 " + name.string());
    EXPECT_THAT(complaint(), AllOf(HasSubstr("rgb.txt:3"), HasSubstr("leaves the folder"))) << name;
  }
  fs::create_symlink(secret, recording_.folder() / "link.png");
  replace_line("rgb.txt", 3, "5.1 link.png");
  EXPECT_THAT(complaint(),
              AllOf(HasSubstr("rgb.txt:3"), HasSubstr("leaves the folder"),
                    HasSubstr("by the link " + (recording_.folder() / "link.png").string())));
  fs::create_directory_symlink(elsewhere.path(), recording_.folder() / "away");
  replace_line("rgb.txt", 3, "5.1 away/secret.png");
  EXPECT_THAT(complaint(), HasSubstr("by the link " + (recording_.folder() / "away").string()));
}

TEST_F(BadSequence, PictureOrVideoThatIsNoFile) {
  fs::create_directory(recording_.folder() / "folder.png");
  replace_line("rgb.txt", 3, "5.1 folder.png");
  EXPECT_THAT(complaint(),
              AllOf(HasSubstr("rgb.txt:3"), HasSubstr("folder.png: a folder, not a file")));
  EXPECT_EQ(complaint_about("/dev/null"), "/dev/null: not a file; expected a video");
}

TEST_F(BadSequence, LinkThatPointsToItself) {
  fs::create_symlink("loop.png", recording_.folder() / "loop.png");
  replace_line("rgb.txt", 3, "5.1 loop.png");
  EXPECT_THAT(complaint(), HasSubstr("rgb.txt:3"));
}

TEST_F(BadSequence, FirstImageContradictsTheCalibration) {
  replace("calib.txt", "30 30 15 11 0 0 0 0 64 48 10\n");
  EXPECT_THAT(complaint(), AllOf(HasSubstr("rgb/000000.png"), HasSubstr("32x24"),
                                 HasSubstr("calib.txt"), HasSubstr("64x48")));
}

TEST_F(BadSequence, LaterImageContradictsTheCalibration) {
  write_png(recording_.folder() / Recording::name(4), Image(16, 12, 3));
  EXPECT_THAT(complaint(),
              AllOf(HasSubstr("rgb/000004.png"), HasSubstr("16x12"), HasSubstr("32x24")));
}

TEST_F(BadSequence, QuaternionThatIsNoRotation) {
  for (const char* rotation : {"0 0 0 0", "1 1 1 1"}) {
    replace_line("groundtruth.txt", 3, std::string("5.1 0 0 0 ") + rotation);
    EXPECT_THAT(complaint(), HasSubstr("groundtruth.txt:3"));
  }
}

TEST_F(BadSequence, SubjectWithoutARadius) {
  for (const char* text : {"0 0 0 0\n", "0 0 0 -1\n", "0 0 0\n", "", "0 0 0 1\n0 0 0 1\n"}) {
    replace("subject.txt", text);
    EXPECT_THAT(complaint(), HasSubstr("subject.txt")) << text;
  }
}

TEST_F(BadSequence, PositionsThatNobodyCanComputeWith) {
  replace("subject.txt", "0 -1e300 0 1\n");
  EXPECT_THAT(complaint(), HasSubstr("subject.txt:1: a coordinate of -1e+300; expected -1e+09 to"));
  replace("subject.txt", "0 0 0 1e300\n");
  EXPECT_THAT(complaint(), AllOf(HasSubstr("subject.txt:1: radius"), HasSubstr("up to 1e9")));
  replace("subject.txt", "0 0 0 1\n");
  replace_line("groundtruth.txt", 3, "5.1 0 0 1e308 0 0 0 1");
  EXPECT_THAT(complaint(), HasSubstr("groundtruth.txt:3: a coordinate of 1e+308; expected"));
}

TEST_F(BadSequence, FileTooLargeToRead) {
  fs::resize_file(recording_.folder() / "rgb.txt", std::uintmax_t{1} << 40U);
  EXPECT_THAT(complaint(), HasSubstr("rgb.txt: 1099511627776 bytes; expected at most"));
}

TEST_F(BadSequence, BinaryInPlaceOfText) {
  for (const char* file : {"rgb.txt", "calib.txt", "groundtruth.txt", "subject.txt"}) {
    const std::string before = testing::read_text(recording_.folder() / file);
    replace(file, std::string("\0\x01\xff\n\0 \0", 7));
    EXPECT_THAT(complaint(), HasSubstr(file));
    replace(file, before);
  }
}

TEST_F(BadSequence, FolderInPlaceOfText) {
  fs::remove(recording_.folder() / "groundtruth.txt");
  fs::create_directory(recording_.folder() / "groundtruth.txt");
  EXPECT_THAT(complaint(), AllOf(HasSubstr("groundtruth.txt"), HasSubstr("not a file")));
}

TEST(BadVideoSequence, FewerFramesThanLines) {
  const Recording recording(Recording::Medium::Video);
  testing::write_video(recording.folder() / "rgb.mp4", 4);
  EXPECT_THAT(complaint_about(recording.folder()),
              AllOf(HasSubstr("rgb.mp4"), HasSubstr("4 frames"), HasSubstr("5 lines")));
}

TEST(BadVideoSequence, TruncatedVideo) {
  const Recording recording(Recording::Medium::Video);
  const fs::path video = recording.folder() / "rgb.mp4";
  fs::resize_file(video, fs::file_size(video) / 2);
  EXPECT_THAT(complaint_about(recording.folder()), HasSubstr("rgb.mp4"));
}

TEST(BadVideoSequence, SizeContradictsTheCalibration) {
  const Recording recording(Recording::Medium::Video);
  recording.dir().write("calib.txt", "30 30 15 11 0 0 0 0 64 48 10\n");
  EXPECT_THAT(complaint_about(recording.folder()),
              AllOf(HasSubstr("rgb.mp4"), HasSubstr("32x24"), HasSubstr("64x48")));
}

}  // namespace
}  // namespace lumibox::hal
