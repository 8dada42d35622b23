// Makes a film for a webcam (guest/feed.cpp) of a recording: every STEPth of its pictures in YUYV,
// one after the other.
//
//   film SEQUENCE STEP FILM
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <vector>

#include "hal/image.h"
#include "hal/image_io.h"
#include "hal/replay/sequence.h"

namespace {

using lumibox::hal::Image;
namespace hal = lumibox::hal;

std::uint8_t byte_of(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

/// Rec. 601 of limited range, as webcams have it; colour of each two neighbours is their mean's.
std::vector<std::uint8_t> yuyv(const Image& rgb) {
  std::vector<std::uint8_t> out;
  out.reserve(rgb.size_bytes() * 2 / 3);
  const auto luma = [](const double* c) {
    return 16.0 + (65.481 * c[0] + 128.553 * c[1] + 24.966 * c[2]) / 255.0;
  };
  for (int y = 0; y < rgb.height(); ++y) {
    for (int x = 0; x + 1 < rgb.width(); x += 2) {
      double left[3], right[3], mean[3];
      for (int c = 0; c < 3; ++c) {
        left[c] = rgb.at(x, y)[c];
        right[c] = rgb.at(x + 1, y)[c];
        mean[c] = 0.5 * (left[c] + right[c]);
      }
      const double u = 128.0 + (-37.797 * mean[0] - 74.203 * mean[1] + 112.0 * mean[2]) / 255.0;
      const double v = 128.0 + (112.0 * mean[0] - 93.786 * mean[1] - 18.214 * mean[2]) / 255.0;
      out.insert(out.end(), {byte_of(luma(left)), byte_of(u), byte_of(luma(right)), byte_of(v)});
    }
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) try {
  const int step = argc == 4 ? std::atoi(argv[2]) : 0;
  if (step < 1) {
    std::fprintf(stderr, "usage: film SEQUENCE STEP FILM\n");
    return 2;
  }
  const auto entries = hal::open_sequence(argv[1]).entries;
  std::ofstream film(argv[3], std::ios::binary);
  for (std::size_t i = 0; i < entries.size(); i += static_cast<std::size_t>(step)) {
    const auto bytes = yuyv(hal::to_rgb(hal::read_image(entries[i].image)));
    film.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  if (!film.flush()) {
    std::fprintf(stderr, "film: %s: cannot be written\n", argv[3]);
    return 1;
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "film: %s\n", error.what());
  return 1;
}
