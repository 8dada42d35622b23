#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <variant>
#include <vector>

#include "hal/live/modes.h"

namespace lumibox::hal::live {
namespace {

Mode mode(PixelFormat format, int width, int height, std::uint32_t rate) {
  return {format, width, height, {1, rate}};
}

std::string chosen(const std::vector<Mode>& modes, const Wish& wish) {
  const auto found = choose(modes, wish);
  return found ? to_string(*found) : "none";
}

const std::vector<Mode> kWebcam = {
    mode(PixelFormat::Mjpeg, 1280, 720, 30), mode(PixelFormat::Mjpeg, 640, 480, 30),
    mode(PixelFormat::Mjpeg, 640, 480, 60),  mode(PixelFormat::Yuyv, 1280, 720, 10),
    mode(PixelFormat::Yuyv, 640, 480, 15),   mode(PixelFormat::Yuyv, 640, 480, 30),
    mode(PixelFormat::Grey, 640, 480, 120),
};

TEST(LiveChoice, PrefersWhatIsNotCompressedWhereThatIsAsFast) {
  EXPECT_EQ(chosen(kWebcam, {std::nullopt, 640, 480, 30}), "yuyv 640x480 at 30 Hz");
  EXPECT_EQ(chosen(kWebcam, {std::nullopt, 1280, 720, 30}), "mjpeg 1280x720 at 30 Hz");
  EXPECT_EQ(chosen(kWebcam, {std::nullopt, 640, 480, 60}), "mjpeg 640x480 at 60 Hz");
}

TEST(LiveChoice, PrefersTheSizeToTheRateAndTheNearestFasterRate) {
  EXPECT_EQ(chosen(kWebcam, {PixelFormat::Yuyv, 1280, 720, 30}), "yuyv 1280x720 at 10 Hz");
  EXPECT_EQ(chosen(kWebcam, {PixelFormat::Yuyv, 640, 480, 20}), "yuyv 640x480 at 30 Hz");
  EXPECT_EQ(chosen(kWebcam, {PixelFormat::Mjpeg, 640, 480, 10}), "mjpeg 640x480 at 30 Hz");
  EXPECT_EQ(chosen(kWebcam, {std::nullopt, 1000, 700, 30}), "mjpeg 1280x720 at 30 Hz");
}

TEST(LiveChoice, PrefersNoMoreFramesThanNeededToTheFormat) {
  EXPECT_EQ(chosen({mode(PixelFormat::Yuyv, 640, 480, 60), mode(PixelFormat::Mjpeg, 640, 480, 30)},
                   {std::nullopt, 640, 480, 30}),
            "mjpeg 640x480 at 30 Hz");
}

TEST(LiveChoice, ThirtyIsTwentyNinePointNineSeven) {
  std::vector<Mode> modes = {mode(PixelFormat::Mjpeg, 640, 480, 30)};
  modes.push_back({PixelFormat::Yuyv, 640, 480, {1001, 30000}});
  EXPECT_EQ(chosen(modes, {std::nullopt, 640, 480, 30}), "yuyv 640x480 at 29.97 Hz");
}

TEST(LiveChoice, TheFormatIsKeptTo) {
  EXPECT_EQ(chosen(kWebcam, {PixelFormat::Mjpeg, 640, 480, 30}), "mjpeg 640x480 at 30 Hz");
  EXPECT_EQ(chosen(kWebcam, {PixelFormat::Grey, 1280, 720, 30}), "grey 640x480 at 120 Hz");
  EXPECT_EQ(chosen(kWebcam, {PixelFormat::Nv12, 640, 480, 30}), "none");
  EXPECT_EQ(chosen({}, {}), "none");
}

RC_GTEST_PROP(LiveChoiceProperty, TheOrderOfTheOffersDoesNotMatter, (const std::uint8_t draw)) {
  const Wish wish{std::nullopt, 320 + 16 * (draw % 64), 480, 5.0 + draw % 60};
  const std::string straight = chosen(kWebcam, wish);
  RC_ASSERT(chosen({kWebcam.rbegin(), kWebcam.rend()}, wish) == straight);
}

TEST(LiveFormats, HaveTheNamesOfTheConfiguration) {
  for (const char* name :
       {"yuyv", "nv12", "yuv420", "rgb", "bgr", "rgbx", "bgrx", "mjpeg", "grey"}) {
    ASSERT_TRUE(format_named(name)) << name;
    EXPECT_STREQ(name_of(*format_named(name)), name);
  }
  EXPECT_FALSE(format_named("auto"));
}

TEST(LiveFormats, APictureHasThePlanesOfItsFormat) {
  const auto sizes = [](PixelFormat format, std::size_t stride) {
    return plane_sizes(make_layout(mode(format, 64, 48, 30), stride, false));
  };
  using Sizes = std::vector<std::size_t>;
  EXPECT_EQ(sizes(PixelFormat::Yuyv, 0), Sizes{128 * 48});
  EXPECT_EQ(sizes(PixelFormat::Nv12, 80), (Sizes{80 * 48, 80 * 24}));
  EXPECT_EQ(sizes(PixelFormat::Yuv420, 80), (Sizes{80 * 48, 40 * 24, 40 * 24}));
  EXPECT_EQ(sizes(PixelFormat::Bgr, 100), Sizes{192 * 48});  // a stride that cannot be
  EXPECT_EQ(sizes(PixelFormat::Bgrx, 256), Sizes{256 * 48});
  EXPECT_TRUE(sizes(PixelFormat::Mjpeg, 64).empty());
  EXPECT_EQ(make_layout(mode(PixelFormat::Yuv420, 64, 48, 30), 80, false).size_bytes, 80U * 72U);
}

TEST(LiveFormats, OnlyLumaAndChromaHaveALimitedRange) {
  EXPECT_TRUE(make_layout(mode(PixelFormat::Yuv420, 64, 48, 30), 0, true).limited_range);
  EXPECT_FALSE(make_layout(mode(PixelFormat::Rgb, 64, 48, 30), 0, true).limited_range);
  EXPECT_FALSE(make_layout(mode(PixelFormat::Grey, 64, 48, 30), 0, true).limited_range);
}

}  // namespace
}  // namespace lumibox::hal::live
