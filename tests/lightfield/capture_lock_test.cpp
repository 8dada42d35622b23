#include "lightfield/capture_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lightfield/fixtures.h"
#include "lightfield/store.h"
#include "support/other_process.h"
#include "support/source_file.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;
using ::testing::EndsWith;
using testing::files_in;
using testing::FolderOfAnother;

constexpr const char* kInUse = "/c: is being recorded to by another process";

/// True if another process could write the folder.
bool is_free(const fs::path& folder) {
  return FolderOfAnother(folder).has_it();
}

TEST(CaptureLock, IsGivenToOneProcessAtATime) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "c");
  {
    const FolderOfAnother other(folder / "c");
    EXPECT_THAT(input_error([&] { CaptureLock(folder / "c"); }), EndsWith(kInUse));
    EXPECT_THROW(CaptureLock(folder / "c"), CaptureInUse);
  }
  const CaptureLock lock(folder / "c");
  EXPECT_FALSE(is_free(folder / "c"));
}

TEST(CaptureLock, IsSharedWithinAProcessAndGoesWithTheLast) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "c");
  fs::create_directory_symlink(folder / "c", folder / "link");
  auto first = std::make_unique<CaptureLock>(folder / "c");
  auto second = std::make_unique<CaptureLock>(folder / "link");
  first.reset();
  EXPECT_FALSE(is_free(folder / "c"));
  second.reset();
  EXPECT_TRUE(is_free(folder / "c"));
}

TEST(CaptureLock, GoesWithAProcessThatIsKilled) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "c");
  const pid_t child = ::fork();
  if (child == 0) {
    const CaptureLock lock(folder / "c");
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(input_error([&] { CaptureLock(folder / "c"); }), "");
}

TEST(CaptureLock, LeavesNothingInTheFolder) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "c");
  const CaptureLock lock(folder / "c");
  EXPECT_TRUE(fs::is_empty(folder / "c"));
}

TEST(CaptureLock, FolderThatIsNotThereIsNamed) {
  EXPECT_THAT(input_error([] { CaptureLock("/nowhere/c"); }),
              EndsWith("/nowhere/c: cannot open: No such file or directory"));
}

TEST(CaptureLock, TwoDoNotBeginOneNewCapture) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "c");
  const FolderOfAnother other(folder / "c");
  EXPECT_THAT(input_error([&] { Store(folder / "c", 90, Writing::Inline); }), EndsWith(kInUse));
  EXPECT_THAT(input_error([&] { save_capture(make_capture(1), folder / "c", 90); }),
              EndsWith(kInUse));
  EXPECT_TRUE(fs::is_empty(folder / "c"));
}

TEST(CaptureLock, AStoreHasItUntilItHasEnded) {
  const TemporaryFolder folder;
  save_capture(make_capture(2), folder / "c", 90);
  ASSERT_TRUE(is_free(folder / "c"));
  const Capture capture = load_capture(folder / "c");
  for (const Writing writing : {Writing::Inline, Writing::Threaded}) {
    Store store(capture, 0, 90, writing);
    EXPECT_FALSE(is_free(folder / "c"));
    EXPECT_EQ(load_capture(folder / "c").light_field.perspectives().size(), 2U) << "for reading";
    store.end();
    store.flush();
    EXPECT_TRUE(is_free(folder / "c"));
  }
}

TEST(CaptureLock, ACaptureThatAnotherHasIsNotGoneOnWith) {
  const TemporaryFolder folder;
  save_capture(make_capture(2), folder / "c", 90);
  const Capture capture = load_capture(folder / "c");
  const auto before = files_in(folder / "c");
  const FolderOfAnother other(folder / "c");
  EXPECT_THAT(input_error([&] { Store(capture, 0, 90, Writing::Threaded); }), EndsWith(kInUse));
  EXPECT_EQ(files_in(folder / "c"), before);
}

}  // namespace
}  // namespace lumibox::lightfield
