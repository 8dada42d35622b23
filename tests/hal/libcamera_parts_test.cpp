// The parts of the libcamera backend that need no camera: holding the exposure, memory of devices.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <utility>
#include <variant>
#include <vector>

#include "hal/libcamera/exposure_hold.h"
#include "hal/libcamera/mapped_planes.h"
#include "hal/owned.h"

namespace lumibox::hal::libcam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const Adjustments kNow{10'000, 2.0F, {{1.5F, 1.8F}}, 0.5F};
const Adjustments kOther{20'000, 2.0F, {{1.5F, 1.8F}}, 0.5F};

/// Shows the hold so many pictures of one kind; what it orders meanwhile.
std::vector<Orders> show(ExposureHold& hold, const Adjustments& adjustments, int pictures) {
  std::vector<Orders> all;
  for (int i = 0; i < pictures; ++i) {
    hold.saw(adjustments);
    if (const auto orders = hold.take_orders()) all.push_back(*orders);
  }
  return all;
}

TEST(LibcameraHold, AStreamBeginsAsTheCameraLikes) {
  ExposureHold hold;
  EXPECT_EQ(hold.begin().automatic, true);
  hold.want(false);
  EXPECT_FALSE(hold.take_orders());
}

TEST(LibcameraHold, WaitsForAPictureToKnowWhatToHold) {
  ExposureHold hold;
  hold.begin();
  hold.want(true);
  EXPECT_FALSE(hold.take_orders());
  hold.saw(kNow);
  hold.want(true);
  EXPECT_TRUE(hold.take_orders());
}

// Some cameras take what they do at that moment for what they shall do.
TEST(LibcameraHold, ValuesAreToldWithTheSwitchAndOnceMoreAfterIt) {
  ExposureHold hold;
  hold.begin();
  hold.saw(kNow);
  hold.want(true);
  const auto first = hold.take_orders();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->automatic, false);
  EXPECT_EQ(first->values.exposure_us, 10'000);
  const auto second = hold.take_orders();
  ASSERT_TRUE(second);
  EXPECT_FALSE(second->automatic);
  EXPECT_EQ(second->values.white_gains, kNow.white_gains);
  EXPECT_FALSE(hold.take_orders());
  hold.want(true);
  EXPECT_FALSE(hold.take_orders());
}

TEST(LibcameraHold, WhatIsHeldIsSaidWhenItIsSo) {
  ExposureHold hold;
  hold.begin();
  hold.saw(kNow);
  hold.want(true);
  show(hold, kNow, 9);
  EXPECT_FALSE(hold.take_news());
  hold.saw(kNow);
  EXPECT_EQ(hold.take_news(),
            "held: exposure in us 1e+04, gain 2, gain of red 1.5, gain of blue 1.8, focus in "
            "dioptres 0.5");
  EXPECT_FALSE(hold.is_fault());
  EXPECT_FALSE(hold.take_news());
  EXPECT_TRUE(show(hold, kOther, 50).empty());  // looked at once
}

TEST(LibcameraHold, WhatDoesNotStickIsToldThreeTimesAndSaid) {
  ExposureHold hold;
  hold.begin();
  hold.saw(kNow);
  hold.want(true);
  EXPECT_EQ(show(hold, kOther, 100).size(), 3U * 2U);
  const auto news = hold.take_news();
  ASSERT_TRUE(news);
  EXPECT_TRUE(hold.is_fault());
  EXPECT_THAT(*news, AllOf(HasSubstr("exposure in us is not set to 1e+04: it is 2e+04"),
                           ::testing::Not(HasSubstr("gain"))));
}

TEST(LibcameraHold, RoundingIsNoFault) {
  ExposureHold hold;
  hold.begin();
  hold.saw(kNow);
  hold.want(true);
  Adjustments rounded = kNow;
  rounded.exposure_us = 10'040;
  rounded.gain = 2.03F;
  rounded.lens_dioptres = 0.52F;
  EXPECT_EQ(show(hold, rounded, 100).size(), 2U);
  EXPECT_TRUE(hold.take_news());
  EXPECT_FALSE(hold.is_fault());
}

TEST(LibcameraHold, OfACameraThatSaysNothingTheSwitchesAreSet) {
  ExposureHold hold;
  hold.begin();
  hold.saw({});
  hold.want(true);
  EXPECT_EQ(hold.take_orders().value().automatic, false);
  show(hold, {}, 10);
  EXPECT_THAT(hold.take_news().value(), HasSubstr("does not say"));
}

TEST(LibcameraHold, ANewStreamIsHeldLikeTheOldOneUntilItIsFreed) {
  ExposureHold hold;
  hold.begin();
  hold.saw(kNow);
  hold.want(true);
  show(hold, kNow, 20);
  const Orders again = hold.begin();
  EXPECT_EQ(again.automatic, false);
  EXPECT_EQ(again.values.exposure_us, 10'000);
  EXPECT_EQ(show(hold, kOther, 100).size(), 1U + 2U * 2U);  // told at the beginning, and twice more
  hold.want(false);
  EXPECT_EQ(hold.take_orders().value().automatic, true);
  EXPECT_EQ(hold.begin().automatic, true);
}

TEST(LibcameraHold, WhatIsForgottenIsNotHeld) {
  ExposureHold hold;
  hold.begin();
  hold.saw(kNow);
  hold.want(true);
  hold.forget();
  EXPECT_EQ(hold.begin().automatic, true);
  EXPECT_FALSE(hold.take_orders());
}

/// A file in memory with the bytes 0, 1, 2, ...
File numbered_file(std::size_t size) {
  File file(memfd_create("planes", MFD_CLOEXEC));
  std::vector<std::uint8_t> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i);
  EXPECT_EQ(write(file.descriptor(), bytes.data(), size), static_cast<ssize_t>(size));
  return file;
}

TEST(LibcameraPlanes, LieWhereTheyAreSaidToBeInOneFileOrSeveral) {
  const File one = numbered_file(200);
  const File other = numbered_file(100);
  auto mapped = MappedPlanes::map(
      {{one.descriptor(), 0, 100}, {one.descriptor(), 120, 80}, {other.descriptor(), 10, 5}});
  ASSERT_TRUE(std::holds_alternative<MappedPlanes>(mapped));
  const MappedPlanes planes = std::get<MappedPlanes>(std::move(mapped));
  planes.begin_read();  // memory that is no dma-buf needs no care, and refuses it
  ASSERT_EQ(planes.planes().size(), 3U);
  EXPECT_EQ(planes.planes()[0].size(), 100U);
  EXPECT_EQ(planes.planes()[0][99], 99);
  EXPECT_EQ(planes.planes()[1].size(), 80U);
  EXPECT_EQ(planes.planes()[1][0], 120);
  EXPECT_EQ(planes.planes()[2][4], 14);
  planes.end_read();
}

TEST(LibcameraPlanes, FilesThatCannotBeMappedAreTold) {
  EXPECT_EQ(std::get<int>(MappedPlanes::map({{-1, 0, 100}})), EBADF);
}

}  // namespace
}  // namespace lumibox::hal::libcam
