#include "config/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "support/file_size_limit.h"
#include "support/input_error.h"
#include "support/source_file.h"
#include "support/temp_dir.h"

namespace lumibox::config {
namespace {

using ::testing::EndsWith;
using testing::message_of;
using testing::read_text;
using testing::TempDir;

TEST(OutputFile, HoldsWhatWasWrittenLast) {
  const TempDir dir;
  const auto file = dir.write("a.txt", "something longer");
  write_text(file, "short\n");
  EXPECT_EQ(read_text(file), "short\n");
}

TEST(OutputFile, OneThatWouldBeCutShortIsRemoved) {
  const TempDir dir;
  std::filesystem::create_symlink("a.txt", dir / "link");
  const testing::FileSizeLimit limit(100);
  for (const char* name : {"a.txt", "link"}) {
    EXPECT_THAT(message_of([&] { write_text(dir / name, std::string(100'000, 'x')); }),
                EndsWith(std::string(name) + ": cannot be written: File too large"));
    EXPECT_FALSE(std::filesystem::exists(dir / "a.txt"));
  }
}

TEST(OutputFile, DevicesStay) {
  EXPECT_THAT(message_of([] { write_text("/dev/full", "text"); }),
              EndsWith("/dev/full: cannot be written: No space left on device"));
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));
}

TEST(OutputFile, FolderThatIsNotThereIsSaid) {
  EXPECT_THAT(message_of([] { write_text("/nowhere/a.txt", "text"); }),
              EndsWith("/nowhere/a.txt: cannot be written: No such file or directory"));
}

}  // namespace
}  // namespace lumibox::config
