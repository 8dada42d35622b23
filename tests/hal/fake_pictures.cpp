#include "hal/fake_pictures.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "hal/image_io.h"

namespace lumibox::testing {
namespace {

using hal::live::PixelFormat;

constexpr int kJpegQuality = 95;

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

/// Y, U and V of Rec. 601.
struct Yuv {
  std::uint8_t y, u, v;
};

Yuv yuv_of(const std::uint8_t* rgb, bool limited) {
  const double y = 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2];
  const double u = (rgb[2] - y) / 1.772;
  const double v = (rgb[0] - y) / 1.402;
  if (!limited) return {to_byte(y), to_byte(128 + u), to_byte(128 + v)};
  return {to_byte(16 + y * 219 / 255), to_byte(128 + u * 224 / 255), to_byte(128 + v * 224 / 255)};
}

/// Writes a picture row by row.
class Writer {
 public:
  Writer(const hal::Image& picture, bool limited, std::size_t padding)
      : picture_(picture), limited_(limited), padding_(padding) {}

  void luma() {
    for (int y = 0; y < picture_.height(); ++y) {
      for (int x = 0; x < picture_.width(); ++x) put({at(x, y).y});
      pad(padding_);
    }
  }

  void yuyv() {
    for (int y = 0; y < picture_.height(); ++y) {
      for (int x = 0; x < picture_.width(); x += 2) {
        put({at(x, y).y, at(x, y).u, at(x + 1, y).y, at(x, y).v});
      }
      pad(padding_);
    }
  }

  void chroma_in_turn() {
    for (int y = 0; y < picture_.height(); y += 2) {
      for (int x = 0; x < picture_.width(); x += 2) put({at(x, y).u, at(x, y).v});
      pad(padding_);
    }
  }

  void chroma(std::uint8_t Yuv::*which) {
    for (int y = 0; y < picture_.height(); y += 2) {
      for (int x = 0; x < picture_.width(); x += 2) put({at(x, y).*which});
      pad(padding_ / 2);
    }
  }

  /// The channels in this order; any but those three is a byte that means nothing.
  void rgb(std::initializer_list<int> channels) {
    constexpr std::uint8_t kUnused = 0x5A;
    for (int y = 0; y < picture_.height(); ++y) {
      for (int x = 0; x < picture_.width(); ++x) {
        for (const int channel : channels)
          put({channel < 3 ? picture_.at(x, y)[channel] : kUnused});
      }
      pad(padding_);
    }
  }

  std::vector<std::uint8_t> bytes;

 private:
  Yuv at(int x, int y) const { return yuv_of(picture_.at(x, y), limited_); }
  void put(std::initializer_list<std::uint8_t> values) {
    bytes.insert(bytes.end(), values.begin(), values.end());
  }
  void pad(std::size_t count) { bytes.insert(bytes.end(), count, 0); }

  const hal::Image& picture_;
  bool limited_;
  std::size_t padding_;
};

}  // namespace

hal::Image picture_of(int number, int width, int height) {
  hal::Image image(width, height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int level = 60 + 16 * (number % 8) + x % 64;
      image.at(x, y)[0] = static_cast<std::uint8_t>(level + 20);
      image.at(x, y)[1] = static_cast<std::uint8_t>(level);
      image.at(x, y)[2] = static_cast<std::uint8_t>(level - 20);
    }
  }
  return image;
}

std::vector<std::uint8_t> encode(const hal::Image& picture, PixelFormat format, bool limited_range,
                                 std::size_t padding) {
  Writer writer(picture, limited_range, padding);
  switch (format) {
    case PixelFormat::Mjpeg:
      return hal::encode_jpeg(picture, kJpegQuality);
    case PixelFormat::Yuyv:
      writer.yuyv();
      break;
    case PixelFormat::Nv12:
      writer.luma();
      writer.chroma_in_turn();
      break;
    case PixelFormat::Yuv420:
      writer.luma();
      writer.chroma(&Yuv::u);
      writer.chroma(&Yuv::v);
      break;
    case PixelFormat::Rgb:
      writer.rgb({0, 1, 2});
      break;
    case PixelFormat::Bgr:
      writer.rgb({2, 1, 0});
      break;
    case PixelFormat::Rgbx:
      writer.rgb({0, 1, 2, 3});
      break;
    case PixelFormat::Bgrx:
      writer.rgb({2, 1, 0, 3});
      break;
    case PixelFormat::Grey:
      writer.luma();
      break;
  }
  return writer.bytes;
}

bool is_silent(Silence silence, int streams, int opened) {
  switch (silence) {
    case Silence::None:
      return false;
    case Silence::UntilBegunAnew:
      return streams < 2;
    case Silence::UntilOpenedAnew:
      return opened < 2;
    case Silence::ForGood:
      return true;
  }
  return true;
}

}  // namespace lumibox::testing
