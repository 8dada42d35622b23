// The parts of all real cameras that decide, without a camera: buffers, numbers, times, recovery.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

#include "hal/image_io.h"
#include "hal/live/filled.h"
#include "hal/live/numbering.h"
#include "hal/live/recovery.h"

namespace lumibox::hal::live {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
using Action = Recovery::Action;

Layout layout_of(PixelFormat format, std::size_t bytes) {
  Layout layout;
  layout.mode = {format, 32, 24, {1, 30}};
  layout.size_bytes = bytes;
  return layout;
}

Damage judge(const std::vector<std::uint8_t>& bytes, const Layout& layout) {
  Filled filled;
  filled.bytes[0] = bytes;
  return damage_of(filled, layout);
}

TEST(FilledBuffers, APictureMustBeAsLongAsItsFormatSays) {
  const Layout layout = layout_of(PixelFormat::Yuyv, 1536);
  EXPECT_EQ(judge(std::vector<std::uint8_t>(1536), layout), Damage::None);
  EXPECT_EQ(judge(std::vector<std::uint8_t>(1535), layout), Damage::Short);
  EXPECT_EQ(judge({}, layout), Damage::Short);
}

TEST(FilledBuffers, WhatTheCameraCallsDamagedIsDamaged) {
  const std::vector<std::uint8_t> bytes(1536);
  Filled filled;
  filled.bytes[0] = bytes;
  filled.faulty = true;
  EXPECT_EQ(damage_of(filled, layout_of(PixelFormat::Yuyv, 1536)), Damage::Faulty);
}

TEST(FilledBuffers, AJpegBeginsAndEndsAsOneAndMayBePaddedWithZeros) {
  const Layout layout = layout_of(PixelFormat::Mjpeg, 0);
  const std::vector<std::uint8_t> whole = encode_jpeg(Image(32, 24, 3), 90);
  EXPECT_EQ(judge(whole, layout), Damage::None);

  std::vector<std::uint8_t> padded = whole;
  padded.resize(whole.size() + 100, 0);
  EXPECT_EQ(judge(padded, layout), Damage::None);

  EXPECT_EQ(judge({whole.begin(), whole.end() - 1}, layout), Damage::NotJpeg);
  EXPECT_EQ(judge({whole.begin() + 1, whole.end()}, layout), Damage::NotJpeg);
  EXPECT_EQ(judge(std::vector<std::uint8_t>(1000), layout), Damage::NotJpeg);
  EXPECT_EQ(judge({0xFF, 0xD8, 0xFF, 0xD9}, layout), Damage::Short);
}

RC_GTEST_PROP(FilledBuffersProperty, AnyBytesAreJudged, (std::vector<std::uint8_t> bytes)) {
  const Damage damage = judge(bytes, layout_of(PixelFormat::Mjpeg, 0));
  RC_ASSERT(damage != Damage::None || (bytes.size() >= 125 && bytes[0] == 0xFF));
}

TEST(LiveNumbering, GapsOfTheDriversSequenceAreGapsOfTheFrames) {
  Numbering numbering;
  EXPECT_EQ(numbering.next(7), 0);  // drivers need not begin at 0
  EXPECT_EQ(numbering.missed(), 0);
  EXPECT_EQ(numbering.next(8), 1);
  EXPECT_EQ(numbering.next(11), 4);
  EXPECT_EQ(numbering.missed(), 2);
}

TEST(LiveNumbering, GoesOnOverStreamsAndWrapsAround) {
  Numbering numbering;
  EXPECT_EQ(numbering.next(0xFFFFFFFF), 0);
  EXPECT_EQ(numbering.next(1), 2);
  numbering.begin_stream();
  EXPECT_EQ(numbering.next(0), 3);
  EXPECT_EQ(numbering.missed(), 0);
}

TEST(LiveNumbering, DriversThatDoNotCountGiveOneByOne) {
  Numbering numbering;
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(numbering.next(0), i);
    EXPECT_EQ(numbering.missed(), 0);
  }
  EXPECT_EQ(numbering.next(5), 9);
  EXPECT_EQ(numbering.next(3), 10);  // a step back
}

Filled stamped(std::int64_t timestamp_ns) {
  Filled filled;
  filled.timestamp_ns = timestamp_ns;
  filled.monotonic = true;
  return filled;
}

TEST(LiveStamping, TakesTheDriversTimeToTheMiddleRow) {
  constexpr std::int64_t kReadout = 20'000'000;
  Stamping stamping(kReadout);
  EXPECT_EQ(stamping.stamp(stamped(kSecond), 2 * kSecond), kSecond - kReadout / 2);
  EXPECT_FALSE(stamping.replaced());
  Filled from_start = stamped(2 * kSecond);
  from_start.start_of_exposure = true;
  EXPECT_EQ(stamping.stamp(from_start, 3 * kSecond), 2 * kSecond + kReadout / 2);
}

TEST(LiveStamping, TimesOfAnotherClockAreReplacedByWhenTheBufferCame) {
  Stamping stamping(0);
  Filled other = stamped(kSecond);
  other.monotonic = false;
  EXPECT_EQ(stamping.stamp(other, 5 * kSecond), 5 * kSecond);
  EXPECT_TRUE(stamping.replaced());
  EXPECT_EQ(stamping.stamp(stamped(99 * kSecond), 6 * kSecond), 6 * kSecond);  // of the future
  EXPECT_TRUE(stamping.replaced());
}

TEST(LiveStamping, ABufferMayBeFilledAMomentAfterTheClockWasRead) {
  Stamping stamping(0);
  EXPECT_EQ(stamping.stamp(stamped(kSecond + 300'000), kSecond), kSecond + 300'000);
  EXPECT_FALSE(stamping.replaced());
}

RC_GTEST_PROP(LiveStampingProperty, TimesIncreaseWhateverTheDriverSays,
              (const std::vector<std::pair<std::int32_t, bool>>& draws)) {
  Stamping stamping(30'000'000);
  std::int64_t now_ns = 10 * kSecond;  // more than any offset
  std::int64_t last_ns = 0;
  for (const auto& [offset, monotonic] : draws) {
    Filled filled = stamped(now_ns + offset);
    filled.monotonic = monotonic;
    filled.start_of_exposure = offset % 2 == 0;
    const std::int64_t stamp_ns = stamping.stamp(filled, now_ns);
    RC_ASSERT(stamp_ns > last_ns);
    last_ns = stamp_ns;
    now_ns += 1000;
  }
}

TEST(LiveRecovery, FramesInTimeNeedNothing) {
  Recovery recovery(2 * kSecond);
  EXPECT_EQ(recovery.due_ns(), Recovery::kNever);
  recovery.began(0);
  for (std::int64_t now = kSecond; now < 20 * kSecond; now += kSecond) {
    EXPECT_EQ(recovery.due(now), Action::None);
    recovery.got_frame(now);
    EXPECT_EQ(recovery.due_ns(), now + 2 * kSecond);
  }
}

TEST(LiveRecovery, AStallIsFirstAnsweredByANewStreamThenByANewDevice) {
  Recovery recovery(2 * kSecond);
  recovery.began(0);
  EXPECT_EQ(recovery.due(2 * kSecond - 1), Action::None);
  EXPECT_EQ(recovery.due(2 * kSecond), Action::Restart);
  EXPECT_EQ(recovery.due(2 * kSecond), Action::None);  // said once
  EXPECT_EQ(recovery.due(4 * kSecond), Action::Close);
  recovery.closed(4 * kSecond);
  EXPECT_EQ(recovery.due(4 * kSecond), Action::None);
  EXPECT_EQ(recovery.due(recovery.due_ns()), Action::Open);
}

TEST(LiveRecovery, AFrameAfterANewStreamMakesAllWell) {
  Recovery recovery(2 * kSecond);
  recovery.began(0);
  EXPECT_EQ(recovery.due(2 * kSecond), Action::Restart);
  recovery.got_frame(3 * kSecond);
  EXPECT_EQ(recovery.due(5 * kSecond), Action::Restart);  // not Close: another stall
}

TEST(LiveRecovery, ADeviceThatIsGoneIsLookedForAtGrowingIntervalsUpToFourSeconds) {
  Recovery recovery(2 * kSecond);
  std::vector<std::int64_t> intervals;
  std::int64_t now = 0;
  for (int attempt = 0; attempt < 7; ++attempt) {
    recovery.closed(now);
    intervals.push_back(recovery.due_ns() - now);
    now = recovery.due_ns();
    EXPECT_EQ(recovery.due(now), Action::Open);
  }
  const std::vector<std::int64_t> expected = {kSecond / 4, kSecond / 2, kSecond,    2 * kSecond,
                                              4 * kSecond, 4 * kSecond, 4 * kSecond};
  EXPECT_EQ(intervals, expected);
}

TEST(LiveRecovery, OnlyAFrameMakesTheIntervalsShortAgain) {
  Recovery recovery(2 * kSecond);
  for (int i = 0; i < 5; ++i) recovery.closed(0);
  recovery.began(0);  // it opens, and gives nothing
  recovery.closed(10 * kSecond);
  EXPECT_EQ(recovery.due_ns(), 14 * kSecond);
  recovery.began(14 * kSecond);
  recovery.got_frame(15 * kSecond);
  recovery.closed(20 * kSecond);
  EXPECT_EQ(recovery.due_ns(), 20 * kSecond + kSecond / 4);
}

TEST(LiveRecovery, ADeviceThatAppearsIsOpenedAtOnce) {
  Recovery recovery(2 * kSecond);
  recovery.began(0);
  recovery.device_appeared(kSecond);  // another one: nobody waits for it
  EXPECT_EQ(recovery.due(kSecond), Action::None);
  for (int i = 0; i < 5; ++i) recovery.closed(kSecond);
  recovery.device_appeared(kSecond + 1);
  EXPECT_EQ(recovery.due(kSecond + 1), Action::Open);
}

TEST(LiveRecovery, NothingIsDueOnceStopped) {
  Recovery recovery(2 * kSecond);
  recovery.began(0);
  recovery.stopped();
  EXPECT_EQ(recovery.due(100 * kSecond), Action::None);
  EXPECT_EQ(recovery.due_ns(), Recovery::kNever);
}

}  // namespace
}  // namespace lumibox::hal::live
