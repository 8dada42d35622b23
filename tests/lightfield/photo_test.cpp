#include "lightfield/photo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <barrier>
#include <thread>

#include "hal/image_io.h"
#include "lightfield/fixtures.h"
#include "support/pinhole.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr std::size_t kBytes = 16 * 12 * 3;  // of small_camera()'s pictures

hal::Image picture(int i) {
  return *make_perspective(i, Eigen::Vector3d::Zero(), small_camera()).photo->rgb();
}

std::string jpeg(const hal::Image& image) {
  const auto bytes = hal::encode_jpeg(image, 90);
  return {bytes.begin(), bytes.end()};
}

/// A photo in memory whose file is a JPEG of it.
class PhotoTest : public ::testing::Test {
 protected:
  PhotoTest() { write_text(file_, jpeg(picture(1))); }

  TemporaryFolder folder_;
  fs::path file_ = folder_ / "a.jpg";
  std::shared_ptr<Photo> photo_ = testing::photo_of(picture(1));
};

TEST_F(PhotoTest, HoldsItsPixelsUntilTheyAreStored) {
  EXPECT_EQ(photo_->bytes_held(), kBytes);
  EXPECT_EQ(*photo_->rgb(), picture(1));
  photo_->stored_in(file_);
  EXPECT_EQ(photo_->bytes_held(), 0U);
  EXPECT_EQ(*photo_->rgb(), hal::read_image(file_)) << "what the file says";
  EXPECT_NE(*photo_->rgb(), picture(1)) << "or the test shows nothing";
  EXPECT_EQ(photo_->bytes_held(), 0U);
  EXPECT_FALSE(photo_->fault());
}

TEST_F(PhotoTest, GivesWhatSomebodyStillHolds) {
  auto pixels = photo_->rgb();
  photo_->stored_in(file_);
  EXPECT_EQ(photo_->rgb(), pixels);
  EXPECT_EQ(photo_->bytes_held(), 0U);
  const std::weak_ptr<const hal::Image> gone = pixels;
  pixels.reset();
  EXPECT_TRUE(gone.expired());
}

TEST_F(PhotoTest, OfAFileHoldsNothing) {
  const Photo photo(file_, *small_camera());
  EXPECT_EQ(photo.width(), 16);
  EXPECT_EQ(photo.height(), 12);
  EXPECT_EQ(photo.bytes_held(), 0U);
  EXPECT_EQ(*photo.rgb(), hal::read_image(file_));
}

TEST_F(PhotoTest, OfAGreyFileHasThreeChannels) {
  hal::write_png(folder_ / "grey.png", hal::to_gray(picture(1)));
  EXPECT_EQ(*Photo(folder_ / "grey.png", *small_camera()).rgb(),
            hal::to_rgb(hal::to_gray(picture(1))));
}

TEST_F(PhotoTest, OfABadFileIsRefusedAtOnce) {
  const auto open = [&](const char* name) {
    return input_error([&] { Photo(folder_ / name, *small_camera()); });
  };
  write_text(folder_ / "cut.jpg", read_text(file_).substr(0, 300));
  write_text(folder_ / "large.jpg", jpeg(hal::Image(17, 12, 3)));
  EXPECT_EQ(open("a.jpg"), "");
  EXPECT_THAT(open("none.jpg"), HasSubstr("none.jpg: no such file"));
  EXPECT_THAT(open("cut.jpg"), HasSubstr("cut.jpg: damaged JPEG"));
  EXPECT_THAT(open("large.jpg"), HasSubstr("large.jpg: is 17x12, its camera says 16x12"));
}

/// Something that happens to a file, and what is said of it.
struct Loss {
  const char* says;
  std::function<void(const fs::path&)> happens;
};

std::vector<Loss> losses() {
  return {{"no such file", [](const fs::path& file) { fs::remove(file); }},
          {"no such file", [](const fs::path& file) { fs::remove_all(file.parent_path()); }},
          {"damaged JPEG",
           [](const fs::path& file) { write_text(file, read_text(file).substr(0, 300)); }},
          {"empty file", [](const fs::path& file) { write_text(file, ""); }},
          {"not an image", [](const fs::path& file) { write_text(file, "something else"); }},
          {"is 32x24, its camera says 16x12",
           [](const fs::path& file) { write_text(file, jpeg(hal::Image(32, 24, 3))); }},
          {"a folder", [](const fs::path& file) {
             fs::remove(file);
             fs::create_directory(file);
           }}};
}

TEST_F(PhotoTest, IsLostForGoodWhenItsFileIs) {
  for (const Loss& loss : losses()) {
    const fs::path file = folder_ / "deep/b.jpg";
    const std::string good = jpeg(picture(2));
    write_text(file, good);
    const auto photo = testing::photo_of(picture(2));
    photo->stored_in(file);
    loss.happens(file);
    EXPECT_FALSE(photo->fault()) << "nobody has asked yet";
    EXPECT_EQ(photo->rgb(), nullptr) << loss.says;
    ASSERT_TRUE(photo->fault()) << loss.says;
    EXPECT_THAT(*photo->fault(), HasSubstr(file.string() + ": "));
    EXPECT_THAT(*photo->fault(), HasSubstr(loss.says));
    EXPECT_EQ(input_error([&] { photo->require_rgb(); }), *photo->fault());
    fs::remove_all(file);
    write_text(file, good);
    EXPECT_EQ(photo->rgb(), nullptr) << "a view does not try again";
    EXPECT_EQ(photo->width(), 16);
  }
}

TEST_F(PhotoTest, IsWhatTheFileShowsNow) {
  photo_->stored_in(file_);
  write_text(file_, jpeg(picture(9)));
  EXPECT_EQ(*photo_->rgb(), hal::read_image(file_));
}

// All hold what they got until everybody has it, and whoever read it, it is in memory once. A large
// picture, or each would be read before the next thread has begun.
TEST_F(PhotoTest, IsInMemoryOnceForAllWhoAskTogether) {
  constexpr int kThreads = 8;
  write_text(file_, jpeg(hal::Image(1280, 960, 3)));
  const Photo photo(file_, geometry::Camera(testing::pinhole(1280, 960, 1000.0)));
  std::vector<std::shared_ptr<const hal::Image>> got(kThreads);
  std::barrier ready(kThreads);
  std::vector<std::thread> threads;
  for (auto& mine : got) {
    threads.emplace_back([&] {
      ready.arrive_and_wait();
      mine = photo.rgb();
    });
  }
  for (std::thread& thread : threads) thread.join();
  ASSERT_TRUE(got.front());
  for (const auto& pixels : got) EXPECT_EQ(pixels, got.front());
}

TEST_F(PhotoTest, IsAlwaysThereWhileAnotherThreadStoresIt) {
  std::vector<std::shared_ptr<Photo>> photos;
  for (int i = 0; i < 50; ++i) photos.push_back(testing::photo_of(picture(1)));
  std::thread writer([&] {
    for (const auto& photo : photos) photo->stored_in(file_);
  });
  for (const auto& photo : photos) EXPECT_TRUE(photo->rgb());
  writer.join();
  for (const auto& photo : photos) EXPECT_EQ(photo->bytes_held(), 0U);
}

}  // namespace
}  // namespace lumibox::lightfield
