#include "render/read_ahead.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <thread>

#include "support/photo.h"
#include "support/temp_dir.h"

namespace lumibox::render {
namespace {

class ReadAheadTest : public ::testing::Test {
 protected:
  /// Photos whose pixels are in files only.
  ReadAhead::Pictures stored(std::size_t count) {
    ReadAhead::Pictures pictures;
    for (std::size_t i = 0; i < count; ++i) {
      const auto photo = testing::photo_of(hal::Image(8, 6, 3));
      testing::store_as_png(*photo, file(i));
      pictures.push_back(photo);
    }
    return pictures;
  }

  std::filesystem::path file(std::size_t i) const { return dir_ / (std::to_string(i) + ".png"); }

  static std::size_t in_memory(const ReadAhead::Pictures& pictures) {
    return static_cast<std::size_t>(
        std::ranges::count_if(pictures, [](const auto& p) { return p->in_memory() != nullptr; }));
  }

  testing::TempDir dir_;
  ReadAhead ahead_;
};

TEST_F(ReadAheadTest, ReadsTheMostUrgentFirstAndEachOnce) {
  const auto pictures = stored(2);
  EXPECT_FALSE(ahead_.read_next()) << "nothing is wanted";
  ahead_.want({pictures[1], pictures[0]});
  EXPECT_TRUE(ahead_.read_next());
  EXPECT_TRUE(pictures[1]->in_memory());
  EXPECT_FALSE(pictures[0]->in_memory());
  ahead_.want(pictures);  // the other one is more urgent now; what was read stays
  EXPECT_TRUE(ahead_.read_next());
  EXPECT_EQ(in_memory(pictures), 2U);
  EXPECT_FALSE(ahead_.read_next());
}

TEST_F(ReadAheadTest, LetsGoOfWhatIsNoLongerWanted) {
  const auto pictures = stored(2);
  ahead_.want(pictures);
  while (ahead_.read_next()) {
  }
  ahead_.want({pictures[1]});
  EXPECT_FALSE(pictures[0]->in_memory());
  EXPECT_TRUE(pictures[1]->in_memory());
}

TEST_F(ReadAheadTest, KeepsNoMoreThanItMay) {
  auto pictures = stored(ReadAhead::kMostKept + 3);
  ahead_.want(pictures);
  while (ahead_.read_next()) {
  }
  EXPECT_EQ(in_memory(pictures), ReadAhead::kMostKept);
  pictures.erase(pictures.begin(), pictures.begin() + 2);  // somebody has taken two
  ahead_.want(pictures);
  while (ahead_.read_next()) {
  }
  EXPECT_EQ(in_memory(pictures), ReadAhead::kMostKept);
  EXPECT_TRUE(pictures[ReadAhead::kMostKept - 1]->in_memory());
}

TEST_F(ReadAheadTest, PictureThatIsLostIsTriedOnceAndTheNextIsRead) {
  const auto pictures = stored(2);
  std::filesystem::remove(file(0));
  ahead_.want(pictures);
  EXPECT_TRUE(ahead_.read_next());
  EXPECT_TRUE(pictures[0]->fault());
  EXPECT_TRUE(ahead_.read_next());
  EXPECT_TRUE(pictures[1]->in_memory());
  EXPECT_FALSE(ahead_.read_next());
}

TEST_F(ReadAheadTest, ThreadReadsWhatIsWantedAndEndsWithWhatIsLeft) {
  const auto pictures = stored(5);
  {
    ReadAheadThread thread;
    thread.pictures().want({pictures[0]});
    while (!pictures[0]->in_memory()) std::this_thread::yield();
    thread.pictures().want(pictures);
  }
  EXPECT_EQ(in_memory(pictures), 0U);
}

}  // namespace
}  // namespace lumibox::render
