#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hal/fake_video.h"
#include "hal/image_io.h"
#include "hal/v4l2/frame_slot.h"
#include "hal/v4l2/pictures.h"

namespace lumibox::hal::v4l2 {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

struct Case {
  PixelFormat format;
  std::uint32_t fourcc;
  std::size_t bytes_per_row;
};
constexpr Case kYuyv{PixelFormat::Yuyv, V4L2_PIX_FMT_YUYV, 2 * kWidth};
constexpr Case kNv12{PixelFormat::Nv12, V4L2_PIX_FMT_NV12, kWidth};
constexpr Case kGrey{PixelFormat::Grey, V4L2_PIX_FMT_GREY, kWidth};
constexpr Case kMjpeg{PixelFormat::Mjpeg, V4L2_PIX_FMT_MJPEG, 0};

RawPicture raw_of(const Case& c, const Image& picture, bool limited = false,
                  std::size_t padding = 0) {
  RawPicture raw;
  raw.layout.mode = {c.format, picture.width(), picture.height(), {1, 30}};
  raw.layout.stride = c.bytes_per_row + padding;
  raw.layout.limited_range = limited;
  raw.bytes = testing::encode(picture, c.fourcc, limited, padding);
  raw.index = 7;
  raw.timestamp_ns = 42;
  return raw;
}

int largest_difference(const Image& a, const Image& b) {
  EXPECT_EQ(a.size_bytes(), b.size_bytes());
  int largest = 0;
  for (std::size_t i = 0; i < std::min(a.size_bytes(), b.size_bytes()); ++i) {
    largest = std::max(largest, std::abs(a.data()[i] - b.data()[i]));
  }
  return largest;
}

/// Colours that change slowly, so that coarse chroma loses little.
const Image& picture() {
  static const Image kPicture = testing::picture_of(2, kWidth, kHeight);
  return kPicture;
}

TEST(V4l2Pictures, EveryFormatGivesTheColoursThatWereSeen) {
  for (const Case& c : {kYuyv, kNv12, kMjpeg}) {
    for (const bool limited : {false, true}) {
      if (c.format == PixelFormat::Mjpeg && limited) continue;
      const auto frame = decode(raw_of(c, picture(), limited));
      ASSERT_TRUE(frame) << name_of(c.format);
      // Rounding, twice with a limited range; JPEG loses more.
      const int tolerance = c.format == PixelFormat::Mjpeg ? 8 : 4;
      EXPECT_LE(largest_difference(*frame->color, picture()), tolerance) << name_of(c.format);
      EXPECT_LE(largest_difference(*frame->gray, to_gray(picture())), tolerance);
      EXPECT_EQ(frame->index, 7);
      EXPECT_EQ(frame->timestamp_ns, 42);
    }
  }
}

TEST(V4l2Pictures, LumaOfFullRangeIsHandedOnAsItIs) {
  for (const Case& c : {kYuyv, kNv12, kGrey}) {
    const auto frame = decode(raw_of(c, picture()));
    EXPECT_LE(largest_difference(*frame->gray, to_gray(picture())), 1) << name_of(c.format);
  }
}

TEST(V4l2Pictures, BlackAndWhiteOfALimitedRangeAreBlackAndWhite) {
  Image picture(kWidth, kHeight, 3);
  std::fill(picture.row(0), picture.row(kHeight / 2), std::uint8_t{255});
  const auto frame = decode(raw_of(kNv12, picture, /*limited=*/true));
  EXPECT_EQ(*frame->gray->at(3, 0), 255);
  EXPECT_EQ(*frame->gray->at(3, kHeight - 1), 0);
}

TEST(V4l2Pictures, GreyCamerasHaveGreyColours) {
  const auto frame = decode(raw_of(kGrey, picture()));
  EXPECT_EQ(*frame->color, to_rgb(*frame->gray));
}

TEST(V4l2Pictures, BytesAtTheEndOfRowsAreLeftOut) {
  for (const Case& c : {kYuyv, kNv12, kGrey}) {
    const auto plain = decode(raw_of(c, picture()));
    const auto padded = decode(raw_of(c, picture(), false, 24));
    EXPECT_EQ(*padded->color, *plain->color) << name_of(c.format);
    EXPECT_EQ(*padded->gray, *plain->gray) << name_of(c.format);
  }
}

/// All segments with a marker taken out of a JPEG.
std::vector<std::uint8_t> without_segments(const std::vector<std::uint8_t>& jpeg,
                                           std::uint8_t marker) {
  std::vector<std::uint8_t> result(jpeg.begin(), jpeg.begin() + 2);
  std::size_t at = 2;
  while (jpeg[at + 1] != 0xDA) {
    const std::size_t length = 2U + 256U * jpeg[at + 2] + jpeg[at + 3];
    if (jpeg[at + 1] != marker) {
      result.insert(result.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(at),
                    jpeg.begin() + static_cast<std::ptrdiff_t>(at + length));
    }
    at += length;
  }
  result.insert(result.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(at), jpeg.end());
  return result;
}

TEST(V4l2Pictures, MotionJpegMayLackTheUsualHuffmanTables) {
  RawPicture raw = raw_of(kMjpeg, picture());
  const auto whole = decode(raw);
  const std::size_t size = raw.bytes.size();
  raw.bytes = without_segments(raw.bytes, 0xC4);
  ASSERT_LT(raw.bytes.size() + 300, size);
  const auto frame = decode(raw);
  ASSERT_TRUE(frame);
  EXPECT_EQ(*frame->color, *whole->color);
}

TEST(V4l2Pictures, BytesWithoutMeaningBeforeTheEndOfAJpegDoNoHarm) {
  RawPicture raw = raw_of(kMjpeg, picture());
  const auto whole = decode(raw);
  raw.bytes.insert(raw.bytes.end() - 2, {0x12, 0x34, 0x56, 0x78, 0x12, 0x34, 0x56, 0x78});
  const auto frame = decode(raw);
  ASSERT_TRUE(frame);
  EXPECT_EQ(*frame->gray, *whole->gray);
}

TEST(V4l2Pictures, ADamagedJpegIsNoPicture) {
  const RawPicture whole = raw_of(kMjpeg, picture());
  RawPicture cut = whole;
  cut.bytes.erase(cut.bytes.end() - 150, cut.bytes.end() - 2);
  EXPECT_FALSE(decode(cut));
  RawPicture garbled = whole;
  std::fill(garbled.bytes.end() - 60, garbled.bytes.end() - 10, std::uint8_t{0xFF});
  EXPECT_FALSE(decode(garbled));
  RawPicture other = whole;
  other.layout.mode.width = 2 * kWidth;
  EXPECT_FALSE(decode(other));
  RawPicture nothing = whole;
  nothing.bytes = {0xFF, 0xD8, 0xFF, 0xD9};
  EXPECT_FALSE(decode(nothing));
}

// Grey JPEGs, and chroma of every sampling, have planes of their own sizes.
TEST(V4l2Pictures, AGreyJpegIsAPicture) {
  RawPicture raw = raw_of(kMjpeg, picture());
  raw.bytes = encode_jpeg(to_gray(picture()), 95);
  const auto frame = decode(raw);
  ASSERT_TRUE(frame);
  EXPECT_EQ(*frame->color, to_rgb(*frame->gray));
}

RawPicture numbered(std::int64_t index) {
  RawPicture raw = raw_of(kMjpeg, picture());
  raw.index = index;
  return raw;
}

RawPicture damaged() {
  RawPicture raw = numbered(99);
  raw.bytes.resize(raw.bytes.size() / 2);
  return raw;
}

TEST(V4l2FrameSlot, KeepsTheNewestAndCountsTheRest) {
  FrameSlot slot;
  EXPECT_FALSE(slot.take());
  slot.put(numbered(0));
  slot.put(numbered(1));
  slot.decode_ahead();
  slot.put(numbered(2));
  EXPECT_EQ(slot.take().value().index, 2);
  EXPECT_FALSE(slot.take());
  EXPECT_EQ(slot.counters().delivered, 1);
  EXPECT_EQ(slot.counters().dropped, 2);
  slot.count_dropped(3);
  EXPECT_EQ(slot.counters().dropped, 5);
}

TEST(V4l2FrameSlot, WhatIsDisplacedUndecodedIsNeverDecoded) {
  FrameSlot slot;
  slot.put(damaged());  // decoding it would count it
  slot.put(numbered(1));
  EXPECT_EQ(slot.take().value().index, 1);
  EXPECT_EQ(slot.counters().dropped, 1);
}

// A damaged picture tells when it is decoded: it is counted then.
TEST(V4l2FrameSlot, DecodesAheadOnlyForALoopThatKeepsUp) {
  FrameSlot slot;
  slot.put(damaged());
  slot.decode_ahead();
  EXPECT_EQ(slot.counters().dropped, 1);

  slot.put(numbered(1));
  slot.put(numbered(2));
  ASSERT_TRUE(slot.take());  // too late for one
  EXPECT_EQ(slot.counters().dropped, 2);
  slot.put(damaged());
  slot.decode_ahead();
  EXPECT_EQ(slot.counters().dropped, 2);
  EXPECT_FALSE(slot.take());
  EXPECT_EQ(slot.counters().dropped, 3);

  slot.put(numbered(4));
  ASSERT_TRUE(slot.take());  // in time again
  slot.put(damaged());
  slot.decode_ahead();
  EXPECT_EQ(slot.counters().dropped, 4);
}

TEST(V4l2FrameSlot, CountsWhatIsForgotten) {
  FrameSlot slot;
  slot.clear();
  EXPECT_EQ(slot.counters().dropped, 0);
  slot.put(numbered(0));
  slot.clear();
  EXPECT_FALSE(slot.take());
  EXPECT_EQ(slot.counters().dropped, 1);
  slot.put(numbered(1));
  slot.decode_ahead();
  slot.clear();
  EXPECT_FALSE(slot.take());
  EXPECT_EQ(slot.counters().dropped, 2);
}

}  // namespace
}  // namespace lumibox::hal::v4l2
