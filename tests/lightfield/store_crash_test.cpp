#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <random>
#include <set>

#include "lightfield/map_files.h"
#include "lightfield/map_fixtures.h"
#include "lightfield/store.h"
#include "support/file_size_limit.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;
using Step = DurableFiles::Step;
using testing::FileSizeLimit;
using ::testing::HasSubstr;

const Sphere kSphere{Eigen::Vector3d(0.1, -0.2, 3.0), 0.7};

Perspective taken(int i) {
  return make_perspective(i, kSphere.center, small_camera());
}

/// A short capture with a wipe, an undo, points and a map that grows.
void act_out(Store& store) {
  store.set_subject(kSphere);
  store.add(taken(0));
  store.add(taken(1));
  store.remove(0);
  store.set_points({{1.0, 2.0, 3.0}});
  store.set_map(std::make_shared<tracking::MapView>(make_map(2)), small_camera());
  store.restore(taken(0));
  store.set_points({{4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}});
  store.set_pose(1, orbit_pose(5, kSphere.center));
  store.add(taken(2));
  store.set_map(std::make_shared<tracking::MapView>(make_map(4, /*seed=*/3)), small_camera());
  store.remove(1);
}

/// A map of before the last operation or after it, none before the first; nothing between.
void expect_whole_map(const fs::path& capture) {
  if (!fs::exists(capture / kMapFile)) return;
  EXPECT_EQ(input_error([&] { read_map(capture, *small_camera(), 2); }), "");
}

TEST(StoreCrash, FolderLoadsAfterEverySingleOperation) {
  const TemporaryFolder folder;
  const fs::path capture = folder / "c";
  bool begun = false;  // once there is a transforms.json, there is one for ever
  int loads = 0;
  const auto check = [&](Step, const fs::path&) {
    begun = begun || fs::exists(capture / "transforms.json");
    if (!begun) return;
    EXPECT_EQ(input_error([&] { load_capture(capture); }), "");
    expect_whole_map(capture);
    ++loads;
  };
  {
    Store store(capture, 90, Writing::Inline, DurableFiles(check));
    act_out(store);
  }
  EXPECT_GT(loads, 60);
  EXPECT_EQ(load_capture(capture).light_field.perspectives().size(), 2U);
  EXPECT_EQ(read_map(capture, *small_camera(), 2).keyframes.size(), 4U);
}

/// A power cut may lose whatever was not synced, so the order of syncs counts, not what a look
/// into the running system's folder shows.
TEST(StoreCrash, NothingIsNamedBeforeItIsSynced) {
  const TemporaryFolder folder;
  std::set<std::string> synced_files;    // temporary files whose bytes are on disk
  std::set<std::string> unsynced_names;  // renamed, but their folder not synced since
  int renames = 0;
  const auto check = [&](Step step, const fs::path& path) {
    if (step == Step::Opened) synced_files.erase(path.string());
    if (step == Step::FileSynced) synced_files.insert(path.string());
    if (step == Step::FolderSynced) {
      std::erase_if(unsynced_names,
                    [&](const std::string& name) { return fs::path(name).parent_path() == path; });
    }
    if (step != Step::Renamed) return;
    ++renames;
    EXPECT_TRUE(synced_files.contains(path.string() + ".tmp")) << path;
    EXPECT_TRUE(unsynced_names.empty()) << *unsynced_names.begin() << " before " << path;
    unsynced_names.insert(path.string());
  };
  {
    Store store(folder / "c", 90, Writing::Inline, DurableFiles(check));
    act_out(store);
  }
  EXPECT_GT(renames, 10);
  EXPECT_TRUE(unsynced_names.empty());
}

/// Perspectives that are gone on with may hang on keyframes that went with the power. Before a map
/// comes that has others of their numbers, what they hang on now is on disk.
TEST(StoreCrash, GoingOnNamesWhatPerspectivesHangOnBeforeTheMapHasItsNextKeyframes) {
  const TemporaryFolder folder;
  {
    Store store(folder / "c", 90, Writing::Inline);
    act_out(store);
  }
  Capture capture = load_capture(folder / "c");
  std::vector<Perspective> perspectives = capture.light_field.perspectives();
  perspectives[0].keyframe = 1;
  capture.light_field = LightField(perspectives, capture.light_field.subject());
  std::vector<std::string> written;
  const auto note = [&](Step step, const fs::path& path) {
    if (step == Step::Renamed) written.push_back(path.filename());
  };
  Store store(capture, 4, 90, Writing::Inline, DurableFiles(note));
  EXPECT_TRUE(written.empty()) << "a capture that is looked at stays as it is";
  store.set_map(std::make_shared<tracking::MapView>(make_map(5, /*seed=*/3)), small_camera());
  const std::vector<std::string> expected = {"transforms.json", "000004.png", "map.json"};
  EXPECT_EQ(written, expected);
  EXPECT_EQ(load_capture(folder / "c").light_field.perspectives()[0].keyframe, 1);
}

/// Runs the capture in a process that is killed after `steps` operations; true if it was.
bool run_and_kill(const fs::path& folder, int steps) {
  const pid_t child = ::fork();
  if (child == 0) {
    const auto count = [&steps](Step, const fs::path&) {
      if (steps-- == 0) ::raise(SIGKILL);
    };
    {
      Store store(folder, 90, Writing::Inline, DurableFiles(count));
      act_out(store);
    }
    ::_exit(0);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
}

TEST(StoreCrash, SurvivesKillMinusNineAtRandomMoments) {
  const TemporaryFolder folder;
  ASSERT_FALSE(run_and_kill(folder / "whole", 1'000'000));
  EXPECT_EQ(load_capture(folder / "whole").light_field.perspectives().size(), 2U);
  std::mt19937 random(1);
  for (int i = 0; i < 12; ++i) {
    const int steps = 8 + static_cast<int>(random() % 80U);
    const fs::path capture = folder / std::to_string(i);
    ASSERT_TRUE(run_and_kill(capture, steps)) << steps;
    EXPECT_EQ(input_error([&] { load_capture(capture); }), "") << steps;
    expect_whole_map(capture);
  }
}

TEST(StoreFull, PictureThatDoesNotFitIsAnErrorAndTheRestStays) {
  for (const Writing writing : {Writing::Inline, Writing::Threaded}) {
    const TemporaryFolder folder;
    Store store(folder / "c", 90, writing);
    store.set_subject(kSphere);
    store.add(taken(0));
    store.flush();
    {
      const FileSizeLimit limit(100);
      store.add(taken(1));
      EXPECT_THAT(input_error([&] { store.flush(); }), HasSubstr("images/000001.jpg"));
    }
    EXPECT_THAT(store.error().value_or(""), HasSubstr("cannot write"));
    store.add(taken(2));  // after an error nothing more is written
    const Capture capture = load_capture(folder / "c");
    EXPECT_EQ(capture.light_field.perspectives().size(), 1U);
    EXPECT_FALSE(fs::exists(folder / "c/images/000001.jpg.tmp"));
  }
}

TEST(StoreFull, TransformsThatDoNotFitLeaveTheOldOnes) {
  const TemporaryFolder folder;
  {
    Store store(folder / "c", 90, Writing::Inline);
    store.add(taken(0));
    const FileSizeLimit limit(900);  // a picture of the test fits, two frames do not
    store.add(taken(1));
    EXPECT_THAT(store.error().value_or(""), HasSubstr("transforms.json"));
    store.remove(0);
  }
  const Capture capture = load_capture(folder / "c");
  ASSERT_EQ(capture.light_field.perspectives().size(), 1U);
  EXPECT_EQ(capture.light_field.perspectives()[0].id, 0);
}

TEST(StoreFull, AMapThatDoesNotFitEndsNothing) {
  const TemporaryFolder folder;
  const auto map = std::make_shared<tracking::MapView>(make_map(4));
  Store store(folder / "c", 90, Writing::Inline);
  store.add(taken(0));
  {
    const FileSizeLimit limit(4000);  // a keyframe's picture fits, map.json does not
    store.set_map(map, small_camera());
    EXPECT_THAT(store.error().value_or(""),
                HasSubstr("map/map.json: cannot write: File too large"));
    store.add(taken(1));
    EXPECT_THAT(input_error([&] { store.flush(); }), HasSubstr("map/map.json"));
  }
  EXPECT_EQ(load_capture(folder / "c").light_field.perspectives().size(), 2U);
  EXPECT_TRUE(fs::is_empty(folder / "c/map")) << "pictures of no map take room";
  store.set_map(map, small_camera());
  EXPECT_EQ(store.error(), std::nullopt) << "there is room again";
  EXPECT_EQ(difference(read_map(folder / "c", *small_camera(), 2), *map), "");
}

TEST(StoreFull, AMapThatDoesNotFitLeavesTheOneBefore) {
  const TemporaryFolder folder;
  Store store(folder / "c", 90, Writing::Inline);
  store.set_map(std::make_shared<tracking::MapView>(make_map(2)), small_camera());
  {
    const FileSizeLimit limit(400);  // not even a picture of the test's noise
    store.set_map(std::make_shared<tracking::MapView>(make_map(3)), small_camera());
    EXPECT_THAT(store.error().value_or(""), HasSubstr("map/"));
  }
  EXPECT_EQ(difference(read_map(folder / "c", *small_camera(), 2), make_map(2)), "");
}

TEST(StoreFull, SmallFileSystem) {
  const TemporaryFolder folder;
  const fs::path disk = folder / "disk";
  fs::create_directory(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=96k") != 0) {
    GTEST_SKIP() << "may not mount a tmpfs here";
  }
  {
    Store store(disk / "c", 90, Writing::Threaded);
    for (int i = 0; i < 60; ++i) store.add(taken(i));
    EXPECT_THAT(input_error([&] { store.flush(); }), HasSubstr("No space left on device"));
    EXPECT_THAT(store.error().value_or(""), HasSubstr((disk / "c").string()));
  }
  const std::size_t kept = load_capture(disk / "c").light_field.perspectives().size();
  EXPECT_LT(kept, 60U);
  ::umount(disk.c_str());
}

}  // namespace
}  // namespace lumibox::lightfield
