#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hal/fake_pictures.h"
#include "hal/image_io.h"
#include "hal/live/frame_slot.h"
#include "hal/live/pictures.h"

namespace lumibox::hal::live {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

RawPicture raw_of(PixelFormat format, const Image& picture, bool limited = false,
                  std::size_t padding = 0) {
  const Mode mode{format, picture.width(), picture.height(), {1, 30}};
  RawPicture raw;
  raw.layout = make_layout(mode, make_layout(mode, 0, limited).stride + padding, limited);
  raw.bytes = testing::encode(picture, format, limited, padding);
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

constexpr PixelFormat kYuvFormats[] = {PixelFormat::Yuyv, PixelFormat::Nv12, PixelFormat::Yuv420};

TEST(LivePictures, EveryFormatGivesTheColoursThatWereSeen) {
  for (const PixelFormat format :
       {PixelFormat::Yuyv, PixelFormat::Nv12, PixelFormat::Yuv420, PixelFormat::Mjpeg}) {
    for (const bool limited : {false, true}) {
      if (format == PixelFormat::Mjpeg && limited) continue;
      const auto frame = decode(raw_of(format, picture(), limited));
      ASSERT_TRUE(frame) << name_of(format);
      // Rounding, twice with a limited range; JPEG loses more.
      const int tolerance = format == PixelFormat::Mjpeg ? 8 : 4;
      EXPECT_LE(largest_difference(*frame->color, picture()), tolerance) << name_of(format);
      EXPECT_LE(largest_difference(*frame->gray, to_gray(picture())), tolerance);
      EXPECT_EQ(frame->index, 7);
      EXPECT_EQ(frame->timestamp_ns, 42);
    }
  }
}

TEST(LivePictures, RgbOfEveryOrderIsHandedOnAsItIs) {
  for (const PixelFormat format :
       {PixelFormat::Rgb, PixelFormat::Bgr, PixelFormat::Rgbx, PixelFormat::Bgrx}) {
    for (const std::size_t padding : {0U, 10U}) {
      const auto frame = decode(raw_of(format, picture(), true, padding));
      ASSERT_TRUE(frame) << name_of(format);
      EXPECT_EQ(*frame->color, picture()) << name_of(format);
      EXPECT_EQ(*frame->gray, to_gray(picture())) << name_of(format);
      EXPECT_EQ(frame->index, 7);
    }
  }
}

TEST(LivePictures, LumaOfFullRangeIsHandedOnAsItIs) {
  for (const PixelFormat format :
       {PixelFormat::Yuyv, PixelFormat::Nv12, PixelFormat::Yuv420, PixelFormat::Grey}) {
    const auto frame = decode(raw_of(format, picture()));
    EXPECT_LE(largest_difference(*frame->gray, to_gray(picture())), 1) << name_of(format);
  }
}

TEST(LivePictures, BlackAndWhiteOfALimitedRangeAreBlackAndWhite) {
  Image picture(kWidth, kHeight, 3);
  std::fill(picture.row(0), picture.row(kHeight / 2), std::uint8_t{255});
  for (const PixelFormat format : kYuvFormats) {
    const auto frame = decode(raw_of(format, picture, /*limited=*/true));
    EXPECT_EQ(*frame->gray->at(3, 0), 255) << name_of(format);
    EXPECT_EQ(*frame->gray->at(3, kHeight - 1), 0) << name_of(format);
  }
}

TEST(LivePictures, GreyCamerasHaveGreyColours) {
  const auto frame = decode(raw_of(PixelFormat::Grey, picture()));
  EXPECT_EQ(*frame->color, to_rgb(*frame->gray));
}

TEST(LivePictures, BytesAtTheEndOfRowsAreLeftOut) {
  for (const PixelFormat format :
       {PixelFormat::Yuyv, PixelFormat::Nv12, PixelFormat::Yuv420, PixelFormat::Grey}) {
    const auto plain = decode(raw_of(format, picture()));
    const auto padded = decode(raw_of(format, picture(), false, 24));
    EXPECT_EQ(*padded->color, *plain->color) << name_of(format);
    EXPECT_EQ(*padded->gray, *plain->gray) << name_of(format);
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

TEST(LivePictures, MotionJpegMayLackTheUsualHuffmanTables) {
  RawPicture raw = raw_of(PixelFormat::Mjpeg, picture());
  const auto whole = decode(raw);
  const std::size_t size = raw.bytes.size();
  raw.bytes = without_segments(raw.bytes, 0xC4);
  ASSERT_LT(raw.bytes.size() + 300, size);
  const auto frame = decode(raw);
  ASSERT_TRUE(frame);
  EXPECT_EQ(*frame->color, *whole->color);
}

TEST(LivePictures, BytesWithoutMeaningBeforeTheEndOfAJpegDoNoHarm) {
  RawPicture raw = raw_of(PixelFormat::Mjpeg, picture());
  const auto whole = decode(raw);
  raw.bytes.insert(raw.bytes.end() - 2, {0x12, 0x34, 0x56, 0x78, 0x12, 0x34, 0x56, 0x78});
  const auto frame = decode(raw);
  ASSERT_TRUE(frame);
  EXPECT_EQ(*frame->gray, *whole->gray);
}

TEST(LivePictures, ADamagedJpegIsNoPicture) {
  const RawPicture whole = raw_of(PixelFormat::Mjpeg, picture());
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
TEST(LivePictures, AGreyJpegIsAPicture) {
  RawPicture raw = raw_of(PixelFormat::Mjpeg, picture());
  raw.bytes = encode_jpeg(to_gray(picture()), 95);
  const auto frame = decode(raw);
  ASSERT_TRUE(frame);
  EXPECT_EQ(*frame->color, to_rgb(*frame->gray));
}

RawPicture numbered(std::int64_t index) {
  RawPicture raw = raw_of(PixelFormat::Mjpeg, picture());
  raw.index = index;
  return raw;
}

RawPicture damaged() {
  RawPicture raw = numbered(99);
  raw.bytes.resize(raw.bytes.size() / 2);
  return raw;
}

TEST(LiveFrameSlot, KeepsTheNewestAndCountsTheRest) {
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

TEST(LiveFrameSlot, WhatIsDisplacedUndecodedIsNeverDecoded) {
  FrameSlot slot;
  slot.put(damaged());  // decoding it would count it
  slot.put(numbered(1));
  EXPECT_EQ(slot.take().value().index, 1);
  EXPECT_EQ(slot.counters().dropped, 1);
}

// A damaged picture tells when it is decoded: it is counted then.
TEST(LiveFrameSlot, DecodesAheadOnlyForALoopThatKeepsUp) {
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

TEST(LiveFrameSlot, CountsWhatIsForgotten) {
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
}  // namespace lumibox::hal::live
