#include "hal/replay/sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hal/image_io.h"
#include "support/input_error.h"
#include "support/recording.h"

namespace lumibox::hal {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::Recording;
using testing::TempDir;

double field_of_view_deg(const config::CameraProfile& profile) {
  return 2.0 * std::atan(profile.width / 2.0 / profile.fx) * 180.0 / std::numbers::pi;
}

TEST(Sequence, OfImagesIsReadInFull) {
  const Recording recording;
  const Sequence sequence = open_sequence(recording.folder());
  EXPECT_FALSE(sequence.video);
  EXPECT_FALSE(sequence.profile_assumed);
  ASSERT_EQ(sequence.entries.size(), 5U);
  EXPECT_EQ(sequence.entries[2].timestamp_ns, 5'200'000'000);
  EXPECT_EQ(read_image(sequence.entries[2].image), Recording::picture(2));
  EXPECT_EQ(sequence.profile.width, 32);
  EXPECT_EQ(sequence.profile.height, 24);
  EXPECT_EQ(sequence.profile.fx, 30.0);
  EXPECT_EQ(sequence.profile.fy, 31.0);
  EXPECT_EQ(sequence.profile.cx, 15.5);
  EXPECT_EQ(sequence.profile.cy, 11.5);
  EXPECT_EQ(sequence.profile.k1, 0.1);
  EXPECT_EQ(sequence.profile.k2, 0.01);
  EXPECT_EQ(sequence.profile.p1, 0.001);
  EXPECT_EQ(sequence.profile.p2, 0.002);
  EXPECT_EQ(sequence.profile.k3, -0.003);
  EXPECT_EQ(sequence.profile.fps, 10.0);
  EXPECT_EQ(sequence.profile.readout_s, 0.02);
  ASSERT_EQ(sequence.ground_truth.size(), 5U);
  EXPECT_EQ(sequence.ground_truth[3].world_from_camera.translation, Eigen::Vector3d(3, 0, 0.5));
  ASSERT_TRUE(sequence.subject);
  EXPECT_EQ(sequence.subject->center, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(sequence.subject->radius, 0.25);
}

TEST(Sequence, OfAVideoNeedsNoneOfTheFilesNamed) {
  const Recording recording(Recording::Medium::Video);
  const Sequence sequence = open_sequence(recording.folder());
  EXPECT_EQ(sequence.video, recording.folder() / "rgb.mp4");
  ASSERT_EQ(sequence.entries.size(), 5U);
  EXPECT_EQ(sequence.entries[4].timestamp_ns, 5'400'000'000);
}

TEST(Sequence, CalibrationGivenOverridesTheOneInTheFolder) {
  const Recording recording;
  const fs::path own = recording.dir().write("own.txt", "40 40 15.5 11.5 0 0 0 0 32 24 10\n");
  EXPECT_EQ(open_sequence(recording.folder(), own).profile.fx, 40.0);
}

TEST(Sequence, CalibrationGivenMayBeACameraProfile) {
  const Recording recording;
  const fs::path own = recording.dir().write(
      "own.toml",
      "model = \"fisheye\"\nwidth = 32\nheight = 24\nfx = 20\nfy = 20\ncx = 15.5\ncy = 11.5\n"
      "k4 = 0.01\n");
  const config::CameraProfile profile = open_sequence(recording.folder(), own).profile;
  EXPECT_EQ(profile.model, config::LensModel::Fisheye);
  EXPECT_EQ(profile.k4, 0.01);
}

TEST(Sequence, CalibrationGivenMustFitThePictures) {
  const Recording recording;
  const fs::path own = recording.dir().write("own.txt", "40 40 15.5 11.5 0 0 0 0 64 48 10\n");
  EXPECT_THAT(testing::message_of([&] { open_sequence(recording.folder(), own); }),
              AllOf(HasSubstr("32x24"), HasSubstr("64x48"), HasSubstr("own.txt")));
}

TEST(Sequence, GroundTruthAndSubjectMayBeMissing) {
  const Recording recording;
  fs::remove(recording.folder() / "groundtruth.txt");
  fs::remove(recording.folder() / "subject.txt");
  const Sequence sequence = open_sequence(recording.folder());
  EXPECT_TRUE(sequence.ground_truth.empty());
  EXPECT_FALSE(sequence.subject);
}

TEST(Sequence, LinesMayEndAsOnWindowsAndNamesMayHoldSpaces) {
  const Recording recording(Recording::Medium::Images, 1);
  recording.dir().write("rgb.txt", "# t f\r\n\r\n  1.5 \t the first.png \r\n");
  write_png(recording.folder() / "the first.png", Recording::picture(0));
  const Sequence sequence = open_sequence(recording.folder());
  ASSERT_EQ(sequence.entries.size(), 1U);
  EXPECT_EQ(sequence.entries[0].image, recording.folder() / "the first.png");
}

TEST(BareVideo, AssumesSixtyDegreesAndTakesTimesFromTheVideo) {
  const TempDir dir;
  testing::write_video(dir / "walk.mp4", 6);
  const Sequence sequence = open_sequence(dir / "walk.mp4");
  EXPECT_TRUE(sequence.profile_assumed);
  EXPECT_NEAR(field_of_view_deg(sequence.profile), 60.0, 1e-9);
  EXPECT_EQ(sequence.profile.cx, 15.5);
  EXPECT_NEAR(sequence.profile.fps, 10.0, 1e-9);
  ASSERT_EQ(sequence.entries.size(), 6U);
  EXPECT_EQ(sequence.entries[0].timestamp_ns, 0);
  EXPECT_EQ(sequence.entries[5].timestamp_ns, 500'000'000);
}

TEST(BareVideo, WithCalibrationAssumesNothing) {
  const TempDir dir;
  testing::write_video(dir / "walk.mp4", 2);
  const fs::path own = dir.write("own.txt", "40 40 15.5 11.5 0 0 0 0 32 24 10\n");
  const Sequence sequence = open_sequence(dir / "walk.mp4", own);
  EXPECT_FALSE(sequence.profile_assumed);
  EXPECT_EQ(sequence.profile.fx, 40.0);
}

TEST(FolderOfImages, AssumesFortyFiveDegreesAndTheOrderOfNames) {
  const TempDir dir;
  for (const char* name : {"b3.PNG", "b0.PNG", "b1.PNG", "b2.PNG"}) {
    write_png(dir / name, Recording::picture(0));
  }
  dir.write("readme.txt", "not a picture");
  const Sequence sequence = open_sequence(dir.path());
  EXPECT_TRUE(sequence.profile_assumed);
  EXPECT_NEAR(field_of_view_deg(sequence.profile), 45.0, 1e-9);
  ASSERT_EQ(sequence.entries.size(), 4U);
  EXPECT_EQ(sequence.entries[1].image, dir / "b1.PNG");
  EXPECT_EQ(sequence.entries[3].timestamp_ns, 100'000'000) << "30 frames per second";
}

TEST(FolderOfImages, WithoutImagesIsRefused) {
  const TempDir dir;
  EXPECT_THAT(testing::message_of([&] { open_sequence(dir.path()); }),
              HasSubstr(dir.path().string()));
}

/// A recording beside the source tree; development machines have some, users do not.
std::optional<Sequence> shared_recording(const std::string& name) {
  const fs::path folder = fs::path(LUMIBOX_SOURCE_DIR) / "../shared/data" / name;
  return fs::exists(folder) ? std::optional(open_sequence(folder)) : std::nullopt;
}

TEST(RealSequence, KitchenIsReadInFull) {
  const std::optional<Sequence> sequence = shared_recording("kitchen");
  if (!sequence) GTEST_SKIP() << "../shared/data/kitchen is absent";
  EXPECT_EQ(sequence->entries.size(), 1000U);
  EXPECT_EQ(sequence->ground_truth.size(), 1000U);
  EXPECT_EQ(sequence->profile.fx, 539.0);
}

TEST(RealSequence, CubeOfTheVispImagesNeedsNoCalibration) {
  const fs::path folder = "/usr/share/visp-images-data/ViSP-images/cube";
  if (!fs::exists(folder)) GTEST_SKIP() << "the package visp-images-data is not installed";
  const Sequence sequence = open_sequence(folder);
  EXPECT_EQ(sequence.entries.size(), 80U);
  EXPECT_EQ(sequence.profile.width, 384);
  EXPECT_TRUE(sequence.profile_assumed);
}

}  // namespace
}  // namespace lumibox::hal
