#include "hal/image_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spng.h>

#include <cmath>
#include <cstdlib>
#include <numeric>

#include "config/error.h"
#include "support/input_error.h"
#include "support/source_file.h"
#include "support/temp_dir.h"

namespace lumibox::hal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Image smooth_picture(int channels) {
  Image image(33, 21, channels);  // odd sides: chroma is halved
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      for (int c = 0; c < channels; ++c) {
        image.at(x, y)[c] = static_cast<std::uint8_t>(50 + 3 * x + 2 * y + 10 * c);
      }
    }
  }
  return image;
}

std::string as_text(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

double mean_difference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size_bytes(); ++i) {
    sum += std::abs(a.data()[i] - b.data()[i]);
  }
  return sum / static_cast<double>(a.size_bytes());
}

/// PNG bytes of raw samples, as they stand in the file, in any of the format's kinds.
std::string encode_png(spng_ihdr header, const std::vector<std::uint8_t>& samples,
                       const spng_plte* palette = nullptr) {
  const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> context(spng_ctx_new(SPNG_CTX_ENCODER),
                                                                    &spng_ctx_free);
  spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_set_ihdr(context.get(), &header);
  if (palette != nullptr) {
    spng_plte copy = *palette;
    spng_set_plte(context.get(), &copy);
  }
  EXPECT_EQ(spng_encode_image(context.get(), samples.data(), samples.size(), SPNG_FMT_RAW,
                              SPNG_ENCODE_FINALIZE),
            SPNG_OK);
  std::size_t size = 0;
  int status = 0;
  char* bytes = static_cast<char*>(spng_get_png_buffer(context.get(), &size, &status));
  const std::string text(bytes, size);
  std::free(bytes);
  return text;
}

class ImageFile : public ::testing::Test {
 protected:
  Image read(const std::string& content) const {
    return read_image(folder_.write("picture.any", content));
  }
  std::string complaint_about(const std::string& content) const {
    return testing::message_of([&] { read(content); });
  }
  /// A damaged file must be refused wherever it is cut.
  void expect_refused_wherever_cut(const std::string& content) const {
    for (std::size_t length = 0; length < content.size(); ++length) {
      EXPECT_THAT(complaint_about(content.substr(0, length)), HasSubstr("picture.any"))
          << length << " of " << content.size() << " bytes";
    }
  }

  testing::TempDir folder_;
};

TEST_F(ImageFile, PngKeepsEveryBit) {
  for (const int channels : {1, 3}) {
    const Image image = smooth_picture(channels);
    write_png(folder_ / "a.png", image);
    EXPECT_EQ(read_image(folder_ / "a.png"), image);
    const ImageInfo info = read_image_info(folder_ / "a.png");
    EXPECT_EQ(info.width, 33);
    EXPECT_EQ(info.height, 21);
    EXPECT_EQ(info.channels, channels);
  }
}

TEST_F(ImageFile, JpegIsCloseAndHasItsChannels) {
  for (const int channels : {1, 3}) {
    const Image image = smooth_picture(channels);
    const std::string jpeg = as_text(encode_jpeg(image, 95));
    const Image back = read(jpeg);
    ASSERT_EQ(back.channels(), channels);
    EXPECT_LT(mean_difference(back, image), 2.0);
    EXPECT_EQ(read_image_info(folder_ / "picture.any").channels, channels);
  }
}

TEST_F(ImageFile, PgmAndPpmAreReadPastComments) {
  Image expected(2, 1, 1);
  expected.data()[0] = '#';
  expected.data()[1] = 7;
  EXPECT_EQ(read("P5 # by hand\n2\n# one row\n1 255\n#\a"), expected);
  EXPECT_EQ(read("P6\n1 1\n255\nabc").channels(), 3);
  EXPECT_EQ(read("P6\n1 1\n255\nabc").data()[2], 'c');
}

TEST_F(ImageFile, EveryKindOfPngIsReducedToEightBits) {
  // Grey of 16 bits, of 1 bit, with alpha; colour of 16 bits, with alpha, from a palette.
  EXPECT_EQ(
      read(encode_png({1, 1, 16, SPNG_COLOR_TYPE_GRAYSCALE, 0, 0, 0}, {0x12, 0x34})).data()[0],
      0x12);
  const Image bits = read(encode_png({2, 1, 1, SPNG_COLOR_TYPE_GRAYSCALE, 0, 0, 0}, {0x40}));
  EXPECT_EQ(bits.channels(), 1);
  EXPECT_EQ(bits.data()[0], 0);
  EXPECT_EQ(bits.data()[1], 255);
  const Image faint =
      read(encode_png({1, 1, 8, SPNG_COLOR_TYPE_GRAYSCALE_ALPHA, 0, 0, 0}, {99, 1}));
  EXPECT_EQ(faint.channels(), 1);
  EXPECT_EQ(faint.data()[0], 99);
  const Image deep =
      read(encode_png({1, 1, 16, SPNG_COLOR_TYPE_TRUECOLOR, 0, 0, 0}, {10, 0, 20, 0, 30, 0}));
  EXPECT_EQ(deep.channels(), 3);
  EXPECT_EQ(deep.data()[2], 30);
  const Image clear =
      read(encode_png({1, 1, 8, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA, 0, 0, 0}, {1, 2, 3, 0}));
  EXPECT_EQ(clear.channels(), 3);
  EXPECT_EQ(clear.data()[1], 2);
  spng_plte palette{};
  palette.n_entries = 2;
  palette.entries[1] = {11, 22, 33, 0};
  const Image indexed =
      read(encode_png({1, 1, 8, SPNG_COLOR_TYPE_INDEXED, 0, 0, 0}, {1}, &palette));
  EXPECT_EQ(indexed.channels(), 3);
  EXPECT_EQ(indexed.data()[0], 11);
}

TEST_F(ImageFile, CutAnywhereIsRefused) {
  expect_refused_wherever_cut(as_text(encode_jpeg(smooth_picture(3), 80)));
  expect_refused_wherever_cut("P6\n2 2\n255\n123456789abc");
  write_png(folder_ / "a.png", smooth_picture(3));
  expect_refused_wherever_cut(testing::read_text(folder_ / "a.png"));
}

TEST_F(ImageFile, FlippedByteOfAPngIsRefused) {
  write_png(folder_ / "a.png", smooth_picture(1));
  const std::string good = testing::read_text(folder_ / "a.png");
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x10);
    EXPECT_THAT(complaint_about(bad), HasSubstr("picture.any")) << "byte " << i;
  }
}

// JPEG has no checksum: a flipped byte may pass, but it must never do harm.
TEST_F(ImageFile, FlippedByteOfAJpegIsRefusedOrHarmless) {
  const std::string good = as_text(encode_jpeg(smooth_picture(3), 80));
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0xff);
    try {
      EXPECT_FALSE(read(bad).empty());
    } catch (const config::InputError&) {
    }
  }
}

TEST_F(ImageFile, OtherContentIsRefusedByName) {
  EXPECT_THAT(complaint_about("hello\n"),
              AllOf(HasSubstr("picture.any"), HasSubstr("not an image")));
  EXPECT_THAT(complaint_about(""), AllOf(HasSubstr("picture.any"), HasSubstr("empty")));
  EXPECT_THAT(testing::message_of([&] { read_image(folder_.path()); }),
              AllOf(HasSubstr(folder_.path().string()), HasSubstr("not a file")));
  EXPECT_THAT(testing::message_of([&] { read_image(folder_ / "none.png"); }),
              AllOf(HasSubstr("none.png"), HasSubstr("no such file")));
  EXPECT_THAT(testing::message_of([&] { read_image("/dev/zero"); }), HasSubstr("not a file"));
}

TEST_F(ImageFile, HeaderThatClaimsTooMuchIsRefusedBeforeMemoryIsAskedFor) {
  EXPECT_THAT(complaint_about("P5\n16385 1\n255\n"), HasSubstr("16385x1"));
  EXPECT_THAT(complaint_about("P5\n16384 16384\n255\n"), HasSubstr("16384x16384"));
  EXPECT_THAT(complaint_about("P5\n99999999999999999999 1\n255\n"), HasSubstr("header"));
  EXPECT_THAT(complaint_about("P5\n0 1\n255\n"), HasSubstr("0x1"));
  EXPECT_THAT(complaint_about("P5\n1 1\n65535\nab"), HasSubstr("65535"));
  EXPECT_THAT(complaint_about("P5\n-1 1\n255\n"), HasSubstr("header"));
}

TEST_F(ImageFile, UnwritablePngIsSaidByName) {
  EXPECT_THAT(testing::message_of([&] { write_png(folder_ / "no/a.png", smooth_picture(1)); }),
              AllOf(HasSubstr("no/a.png"), HasSubstr("cannot be written")));
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_THAT(testing::message_of([&] {
                  std::filesystem::create_symlink("/dev/full", folder_ / "full.png");
                  write_png(folder_ / "full.png", smooth_picture(1));
                }),
                AllOf(HasSubstr("full.png"), HasSubstr("No space")));
  }
}

}  // namespace
}  // namespace lumibox::hal
