#include "app/saved_capture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/moments.h"
#include "app/recorder.h"
#include "support/other_process.h"
#include "support/temp_dir.h"

namespace lumibox::app {
namespace {

using ::testing::AllOf;
using testing::around_subject;
using ::testing::HasSubstr;
using testing::TempDir;

/// Records a perspective into a new capture; its folder.
std::filesystem::path record(const std::filesystem::path& captures, bool keep_map) {
  testing::World world;
  const auto folder = next_capture_folder(captures);
  Recorder recorder(testing::small_camera(), config::Capture{}, lightfield::Writing::Inline);
  const Moment moment = world.see_from(around_subject(0.1));
  recorder.begin({Eigen::Vector3d::UnitZ(), 0.3}, moment, folder);
  recorder.record(moment);
  if (keep_map) {
    recorder.keep_map(moment);
  }
  return folder;
}

std::optional<SavedCapture> find(const std::filesystem::path& captures) {
  return find_saved_capture(captures, testing::small_camera(), 2);
}

TEST(SavedCapture, NoneIsFoundWhereThereIsNone) {
  const TempDir dir;
  EXPECT_FALSE(find(dir.path()));
  EXPECT_FALSE(find(dir / "nowhere"));
  dir.write("capture-none/transforms.json", "{}");
  dir.write("capture-7/transforms.json", "{}");
  EXPECT_FALSE(find(dir.path()));
  EXPECT_EQ(next_capture_folder(dir.path()), dir / "capture-0001");
}

TEST(SavedCapture, TheLastIsFoundWithItsMap) {
  const TempDir dir;
  record(dir.path(), true);
  record(dir.path(), true);
  std::filesystem::remove_all(dir / "capture-0001");
  const auto saved = find(dir.path());
  ASSERT_TRUE(saved);
  EXPECT_EQ(saved->name(), "capture-0002");
  EXPECT_EQ(saved->problem, "");
  EXPECT_EQ(saved->map->keyframes.size(), 1U);
  EXPECT_EQ(next_capture_folder(dir.path()), dir / "capture-0003");
}

TEST(SavedCapture, AMapThatIsMissingOrDamagedIsAProblemAndThePerspectivesAreThere) {
  const TempDir dir;
  const auto folder = record(dir.path(), false);
  ASSERT_TRUE(find(dir.path()));
  EXPECT_THAT(find(dir.path())->problem, HasSubstr((folder / "map/map.json").string()));
  EXPECT_EQ(find(dir.path())->capture.light_field.perspectives().size(), 1U);
  dir.write("capture-0001/map/map.json", "not a map");
  EXPECT_THAT(find(dir.path())->problem, HasSubstr("map/map.json:1: not valid JSON"));
  EXPECT_EQ(find(dir.path())->map, nullptr);
}

TEST(SavedCapture, WhyItCannotBeGoneOnWithIsInTheLog) {
  const TempDir dir;
  record(dir.path(), true);
  dir.write("capture-0001/map/map.json", "not a map");
  ::testing::internal::CaptureStdout();
  EXPECT_TRUE(find(dir.path()));
  EXPECT_THAT(::testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr("warning"), HasSubstr("map/map.json:1: not valid JSON")));
}

TEST(SavedCapture, OneThatAnotherProcessRecordsToIsNotTaken) {
  const TempDir dir;
  const auto folder = record(dir.path(), true);
  const testing::FolderOfAnother other(folder);
  EXPECT_THROW(find(dir.path()), lightfield::CaptureInUse);
}

TEST(SavedCapture, NoOtherProcessCanRecordToOneThatIsFound) {
  const TempDir dir;
  const auto folder = record(dir.path(), true);
  auto saved = find(dir.path());
  EXPECT_FALSE(testing::FolderOfAnother(folder).has_it());
  Recorder recorder(testing::small_camera(), config::Capture{}, lightfield::Writing::Inline);
  const testing::World world;
  const MapNow map = world.map();
  recorder.resume(std::move(saved->capture), &map);
  saved.reset();
  EXPECT_FALSE(testing::FolderOfAnother(folder).has_it()) << "the recorder has it now";
  recorder.close(map);
  EXPECT_TRUE(testing::FolderOfAnother(folder).has_it());
}

TEST(SavedCapture, AMapOfAnotherCameraIsAProblem) {
  const TempDir dir;
  record(dir.path(), true);
  const auto saved = find_saved_capture(dir.path(), testing::pinhole(64, 48, 61.0), 2);
  EXPECT_THAT(saved->problem, HasSubstr("camera.fx is 60, but the camera's is 61"));
}

TEST(SavedCapture, ACaptureThatCannotBeReadIsLeftAlone) {
  const TempDir dir;
  record(dir.path(), true);
  dir.write("capture-0002/transforms.json", "damaged");
  EXPECT_FALSE(find(dir.path()));
  EXPECT_EQ(next_capture_folder(dir.path()), dir / "capture-0003");
}

}  // namespace
}  // namespace lumibox::app
